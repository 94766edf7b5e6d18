// Disparity maps of another matcher, compared with ours.
#pragma once

#include <string>
#include <vector>

#include "roadstereo/image.hpp"

namespace CLI {
class App;
}

namespace roadstereo::cli {

/// Folder of disparity maps, one file per frame: FRAME.png, .tiff, .tif or .pfm, as `io::read_disparity` reads them.
struct GivenMaps {
  std::string name;  ///< of the method, in tables
  std::string folder;
};

/// Add --maps NAME=DIR, which may be repeated.
void add_maps_option(CLI::App& command, std::vector<GivenMaps>& maps);

/// Parse NAME=DIR. Throws Error unless NAME is new among `known` and DIR is a folder.
GivenMaps parse_given_maps(const std::string& text, const std::vector<std::string>& known);

/// Read the map of a frame. Throws Error when there is no file of that name, or its size is another.
Image<float> read_given_map(const GivenMaps& maps, const std::string& frame, int width, int height);

}  // namespace roadstereo::cli
