#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pair_source.hpp"

namespace roadstereo::cli {

/// One scene of Middlebury v3 with its truth.
struct MiddleburyScene {
  std::string name;
  StereoPair pair;
  Image<float> truth;
  Image<std::uint8_t> seen_twice;  ///< 255 where both cameras see the point
  int disparities = 0;             ///< ndisp of calib.txt
};

/// Folders of scenes: `folder` itself when it has an im0.png, else those of its sub-folders that do, by name. Throws
/// Error when there is none.
std::vector<std::string> find_middlebury_scenes(const std::string& folder);

/// Reads one scene. Throws Error naming the file that is missing or lacks ndisp.
MiddleburyScene read_middlebury_scene(const std::string& folder);

}  // namespace roadstereo::cli
