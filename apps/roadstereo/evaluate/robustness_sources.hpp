#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "evaluate/labelled_frame.hpp"

namespace roadstereo::cli {

/// Single pairs of one kind with the ground truth of their roads.
struct LabelledSource {
  std::string name;                                         ///< of the folder and its parent
  std::vector<std::string> frames;                          ///< names
  std::function<LabelledFrame(std::size_t)> read_labelled;  ///< by index in `frames`
};

/// Successive pairs.
struct Drive {
  std::string name;    ///< of the folder and its parent
  std::string folder;  ///< what io::open_source takes
  std::vector<std::string> calibration;
};

struct RobustnessSources {
  std::vector<LabelledSource> labelled;
  std::vector<Drive> drives;
};

/// Find the sources in the folders and their subfolders, sorted by path. A folder is recognised by content: the layout
/// of KITTI Stereo 2015 with road masks in road/; folders of one scene each (left.png, right.png, disparity.tiff,
/// occ.png, region.png); a recording with its calibration.yaml. Throws Error naming a folder without any.
RobustnessSources find_robustness_sources(const std::vector<std::string>& folders);

}  // namespace roadstereo::cli
