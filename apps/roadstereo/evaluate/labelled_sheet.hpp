#pragma once

#include <string>
#include <vector>

#include "evaluate/kitti_frames.hpp"
#include "evaluation/picture_sheet.hpp"

namespace roadstereo::cli {

/// Disparity map of a method.
struct NamedMap {
  std::string method;
  ImageView<const float> disparity;
};

/// One row of the sheet as in the paper's figure: left image with the road in magenta, truth, our disparities, and the
/// errors of ours and of a peer.
std::vector<io::SheetCell> labelled_sheet_row(const std::string& name, const LabelledFrame& frame,
                                              const std::vector<NamedMap>& ours, const NamedMap& peer);

}  // namespace roadstereo::cli
