#include "evaluate/given_maps.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>

#include "core/require_size.hpp"
#include "evaluate/methods.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/io/image_file.hpp"

namespace roadstereo::cli {

namespace fs = std::filesystem;

GivenMaps parse_given_maps(const std::string& text, const std::vector<std::string>& known) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) fail("--maps ", text, ": it must be NAME=DIR");
  GivenMaps maps{text.substr(0, equals), text.substr(equals + 1)};
  if (std::find(known.begin(), known.end(), maps.name) != known.end()) {
    fail("--maps ", text, ": ", maps.name, " is the name of another method of the table; use a new name");
  }
  if (!fs::is_directory(maps.folder)) fail("--maps ", text, ": ", maps.folder, " is not a folder");
  return maps;
}

void add_maps_option(CLI::App& command, std::vector<GivenMaps>& maps) {
  command
      .add_option_function<std::vector<std::string>>(
          "--maps",
          [&maps](const std::vector<std::string>& texts) {
            std::vector<std::string> known = method_names();
            for (const std::string& text : texts) {
              maps.push_back(parse_given_maps(text, known));
              known.push_back(maps.back().name);
            }
          },
          "Also score the disparity maps DIR/FRAME.png (16 bit, 1/256 px), .tiff or .pfm under this name; may be "
          "repeated")
      ->type_name("NAME=DIR")
      ->expected(1)
      ->allow_extra_args(false)
      ->take_all();
}

Image<float> read_given_map(const GivenMaps& maps, const std::string& frame, int width, int height) {
  for (const char* ending : {".png", ".tiff", ".tif", ".pfm"}) {
    const fs::path file = fs::path(maps.folder) / (frame + ending);
    if (!fs::is_regular_file(file)) continue;
    Image<float> map = io::read_disparity(file.string());
    require_same_size(file.c_str(), map_size(map), "the left image", {width, height});
    return map;
  }
  fail(maps.folder, ": the folder contains no ", frame, ".png, .tiff, .tif or .pfm");
}

}  // namespace roadstereo::cli
