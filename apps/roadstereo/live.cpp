#include "commands.hpp"
#include "live/live_command.hpp"

namespace roadstereo::cli {

void add_live(CLI::App& app) {
  add_live_command(app, io::open_source);
}

}  // namespace roadstereo::cli
