#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "roadstereo/calibration.hpp"
#include "roadstereo/damage.hpp"
#include "roadstereo/image.hpp"

#pragma GCC visibility push(default)
namespace roadstereo::io {

/// What a road on which no damage was found can have all the same.
struct InspectionLimits {
  std::vector<std::string> doubts{};  ///< why the road was not inspected reliably; empty: it was
  std::string limit{};                ///< the depth that is found, in words; empty: unknown
};

/// Input of `damage_report`. Maps and image have the size of `map`; empty ones are absent.
struct DamageReportInput {
  const DamageMap& map;
  FrameView left{};                                         ///< absent: the coloured transformed map is shown instead
  double white_level = 0;                                   ///< of the left image, as in to_grey
  ImageView<const float> disparity{};                       ///< ℓ, px; NaN invalid
  ImageView<const float> transformed{};                     ///< ℓ', px; marks the holes if ℓ is absent
  std::optional<StereoCalibration> calibration{};           ///< with ℓ: cross-sections and 3-D views are metric
  std::string title{};                                      ///< the frame's name
  std::vector<std::pair<std::string, std::string>> head{};  ///< road, operator, date: name, value
  std::vector<std::pair<std::string, std::string>> properties{};  ///< of the processing, for the appendix
  SeverityScheme severity = astm_d6433();                         ///< by which the damages were graded
  std::vector<std::uint8_t> sheet{};                              ///< the result sheet, PNG or JPEG
  std::vector<std::string> warnings{};                            ///< of the pair, for the top of the report
  InspectionLimits limits{};
};

/// Returns a self-contained HTML report: styles, scripts and images are embedded. Throws Error if the
/// sizes differ or the sheet cannot be decoded.
std::string damage_report(const DamageReportInput& input);

/// Background of the overlay, 8-bit BGR: the left image, else the coloured transformed map, else the coloured depths.
Frame damage_background(const DamageReportInput& input);

}  // namespace roadstereo::io
#pragma GCC visibility pop
