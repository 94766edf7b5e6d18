#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pair_source.hpp"

namespace roadstereo::cli {

/// Scene of Middlebury v3 with ground truth.
struct MiddleburyScene {
  std::string name;
  StereoPair pair;
  Image<float> truth;
  Image<std::uint8_t> visible;  ///< 255 where both cameras see the point
  int disparities = 0;          ///< ndisp of calib.txt
};

/// Find folders of scenes: `folder` itself if it contains im0.png, else its subfolders that do, sorted by name. Throws
/// Error if there is none.
std::vector<std::string> find_middlebury_scenes(const std::string& folder);

/// Read one scene. Throws Error naming the file that is missing or has no valid ndisp.
MiddleburyScene read_middlebury_scene(const std::string& folder);

}  // namespace roadstereo::cli
