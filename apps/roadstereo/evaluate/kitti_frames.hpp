#pragma once

#include <string>
#include <vector>

#include "evaluate/labelled_frame.hpp"

namespace roadstereo::cli {

/// Files of one frame of KITTI Stereo 2015.
struct KittiFiles {
  std::string name;  ///< e.g. "000003_10"
  std::string left, right, truth;
  std::string calibration;  ///< empty if there is none
  std::string road;         ///< road mask; empty if there is none
};

/// Find the frames of `folder` that have a ground truth in disp_noc_0, sorted by name. Masks are read from
/// `road_masks`, or from folder/road if that is empty. Throws Error naming the folder or the file that is missing.
std::vector<KittiFiles> find_kitti_frames(const std::string& folder, const std::string& road_masks);

/// Read one frame. Without a calibration file the intrinsics of the KITTI recording days are used; the width of the
/// images identifies the day.
LabelledFrame read_kitti_frame(const KittiFiles& files);

}  // namespace roadstereo::cli
