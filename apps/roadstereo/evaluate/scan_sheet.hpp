#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "evaluate/scan_frames.hpp"
#include "evaluate/scan_score.hpp"
#include "evaluation/picture_sheet.hpp"

namespace roadstereo::cli {

/// The left image around the labelled pothole, the label in magenta.
io::SheetCell pothole_picture(const std::string& name, const StereoPair& pair, ImageView<const std::uint8_t> label);

/// Distance of every labelled pixel to the scan, 0 to 6 mm, cut out like the left image; black: no disparity.
io::SheetCell distance_picture(const std::string& method, const ScanScore& score, const LabelledPoints& found,
                               const std::vector<ScanDistance>& distances, ImageView<const std::uint8_t> label);

/// A cloud without pixels seen along the scan's shortest main axis, half a millimetre a pixel.
Frame distance_plan(const Points& cloud, const ScanModel& scan, const RigidMotion& motion);

}  // namespace roadstereo::cli
