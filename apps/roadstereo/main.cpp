#include "command_line.hpp"

int main(int argc, char** argv) {
  return roadstereo::cli::run_command_line(argc, argv);
}
