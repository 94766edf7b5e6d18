#pragma once

#include <string>
#include <vector>

#include "evaluate/labelled_frame.hpp"
#include "evaluation/polygon_mask.hpp"

namespace roadstereo::cli {

/// Files of one frame of KITTI Stereo 2012 or 2015.
struct KittiFiles {
  std::string name;  ///< e.g. "000003_10"
  std::string left, right, truth;
  std::string calibration;          ///< empty if there is none
  std::string road;                 ///< road mask; empty if there is none
  std::vector<Polygon> polygons{};  ///< of the road, instead of a mask

  bool has_road() const { return !road.empty() || !polygons.empty(); }
};

/// Find the frames of `folder` that have a ground truth, sorted by name: KITTI Stereo 2015 (image_2, image_3,
/// disp_noc_0, calib_cam_to_cam) or 2012 (colored_0, colored_1, or image_0, image_1 in grey; disp_noc, calib). Masks
/// are read from `road_masks`: a folder, or a JSON file of polygons (road_polygons.hpp); if it is empty, from
/// folder/road. Throws Error naming the folder or the file that is missing, or `road_masks` if it has none of them.
std::vector<KittiFiles> find_kitti_frames(const std::string& folder, const std::string& road_masks);

/// Read one frame. Throws Error when truth or mask do not have the size of the pair. Without a calibration file the
/// intrinsics of the KITTI recording days are used; the width of the images identifies the day.
LabelledFrame read_kitti_frame(const KittiFiles& files);

}  // namespace roadstereo::cli
