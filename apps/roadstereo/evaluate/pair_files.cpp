#include "evaluate/pair_files.hpp"

#include <CLI/CLI.hpp>

#include "calibration_yaml.hpp"
#include "roadstereo/io/image_file.hpp"

namespace roadstereo::cli {

CLI::Option* add_write_pairs_option(CLI::App& command, std::string& folder) {
  return command
      .add_option(
          "--write-pairs", folder,
          "Write the rendered pairs, left/FRAME.png, right/FRAME.png and calibration/FRAME.yaml, for --maps, and "
          "match nothing")
      ->type_name("DIR")
      ->excludes("--maps")
      ->excludes("--json");
}

void add_pair(const std::string& frame, const StereoPair& pair, io::OutputFolder& folder) {
  folder.add("left/" + frame + ".png", io::encode_png(pair.left.view()));
  folder.add("right/" + frame + ".png", io::encode_png(pair.right.view()));
  if (pair.calibration) folder.add("calibration/" + frame + ".yaml", plain_yaml(*pair.calibration));
}

}  // namespace roadstereo::cli
