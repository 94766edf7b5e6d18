#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "roadstereo/calibration.hpp"
#include "roadstereo/damage.hpp"
#include "roadstereo/image.hpp"

namespace roadstereo::io {

/// What is told about the damage of one frame. Maps and image have the map's size; empty ones are absent.
struct DamageReportInput {
  const DamageMap& map;
  FrameView left{};                                ///< absent: the transformed map, coloured, in its place
  ImageView<const float> disparity{};              ///< ℓ; NaN in the holes
  ImageView<const float> transformed{};            ///< ℓ'; tells the holes where there is no ℓ
  std::optional<StereoCalibration> calibration{};  ///< with ℓ, puts cross-sections and 3-D views on the road
  std::string title{};                             ///< the frame's name
  std::vector<std::pair<std::string, std::string>> facts{};  ///< key figures of the frame: name, value with unit
  std::vector<std::uint8_t> sheet{};                         ///< the result sheet, PNG or JPEG
};

/// The report as one HTML file that needs nothing else: styles, scripts and pictures are inside. Throws Error when the
/// sizes differ or the sheet is not a picture.
std::string damage_report(const DamageReportInput& input);

/// The picture that damage is shown on, 8-bit BGR: the left image, else the transformed map coloured, else the depths.
Frame damage_background(const DamageReportInput& input);

}  // namespace roadstereo::io
