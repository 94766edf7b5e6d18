#pragma once

#include <opencv2/core.hpp>
#include <string>

#include "io/report/pictures.hpp"
#include "roadstereo/io/damage_report.hpp"

namespace roadstereo::io {

/// How much a report of so many damages may show of each.
struct SectionSize {
  PictureLimit picture;   ///< each of the two
  int relief_points = 0;  ///< points of a 3-D view along its longest side

  static SectionSize for_count(std::size_t damages);
};

/// How many of the deepest damages have a 3-D view.
inline constexpr std::size_t max_reliefs = 30;

/// The section of one damage: its figures, image, depths, cross-section and, `with_relief`, 3-D view. `background` is
/// that of the report, 8-bit BGR.
std::string damage_section(const DamageReportInput& input, const cv::Mat& background, const Damage& damage,
                           const SectionSize& size, bool with_relief);

}  // namespace roadstereo::io
