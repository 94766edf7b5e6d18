// `roadstereo live` on a synthetic flight out of memory, for tests in a browser and for measurements:
//   live_player WIDTH HEIGHT CALIBRATION live PAIRS [options of live]
// renders the flight at that size, writes its CALIBRATION, and plays so many pairs at 30 Hz or at --rate.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <fstream>
#include <string>

#include "live/live_command.hpp"
#include "synth_files.hpp"
#include "tests/live/memory_source.hpp"

int main(int argc, char** argv) {
  using namespace roadstereo;
  if (argc < 6) {
    std::fprintf(stderr, "usage: live_player WIDTH HEIGHT CALIBRATION live PAIRS [options of live]\n");
    return 2;
  }
  try {
    constexpr int frames = 12;
    constexpr double interval_s = 1.0 / 30;
    const MemoryFlight flight = fly(std::stoi(argv[1]), std::stoi(argv[2]), frames);
    std::ofstream(argv[3]) << cli::plain_yaml(flight.calibration);
    CLI::App app;
    cli::add_live_command(app, [&flight](const std::vector<std::string>& names, const io::SourceOptions&) {
      return std::make_unique<MemorySource>(flight.frames,
                                            MemoryPlan{std::stoll(names.at(0)), interval_s, false, "", -1});
    });
    app.parse(argc - 3, argv + 3);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "live_player: %s\n", error.what());
    return 1;
  }
}
