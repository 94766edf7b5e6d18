#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "pair_source.hpp"

namespace roadstereo::cli {

/// The files of one frame of KITTI Stereo 2015.
struct KittiFiles {
  std::string name;  ///< e.g. "000003_10"
  std::string left, right, truth;
  std::string calibration;  ///< empty when the folder has none
  std::string road;         ///< mask of the road; empty when there is none
};

/// One frame with its truth.
struct KittiFrame {
  StereoPair pair;
  Image<float> truth;                       ///< NaN where the lidar saw nothing
  std::optional<Image<std::uint8_t>> road;  ///< not 0 where the road is
};

/// Every frame of `folder` that has a truth in disp_noc_0, by name. Masks come from `road_masks`, or from the folder
/// "road" when that is empty. Throws Error naming the folder or the file that is missing.
std::vector<KittiFiles> find_kitti_frames(const std::string& folder, const std::string& road_masks);

/// Reads one frame. Without a calibration file the intrinsics of KITTI's recording days are used, which the width of
/// the images tells apart.
KittiFrame read_kitti_frame(const KittiFiles& files);

}  // namespace roadstereo::cli
