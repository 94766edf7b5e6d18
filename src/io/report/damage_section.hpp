#pragma once

#include <opencv2/core.hpp>
#include <string>

#include "io/report/pictures.hpp"
#include "roadstereo/io/damage_report.hpp"

namespace roadstereo::io {

/// Size limits of one damage in a report with that many damages.
struct SectionSize {
  PictureLimit picture;   ///< of each image
  int relief_points = 0;  ///< points along the longer side of a 3-D view

  static SectionSize for_count(std::size_t damages);
};

/// Number of damages with a 3-D view, deepest first.
inline constexpr std::size_t max_reliefs = 30;

/// What a section shows of a damage.
struct SectionOptions {
  SectionSize size;
  bool with_relief = true;
  std::string id;             ///< shown number
  std::string where;          ///< HTML under the title
  bool in_recording = false;  ///< other frames may show more of what the border cuts: its size is that in this frame
};

/// Returns the section of one damage: values, image, depths, cross-section and 3-D view. `background` is the background
/// image of the report, 8-bit BGR.
std::string damage_section(const DamageReportInput& input, const cv::Mat& background, const Damage& damage,
                           const SectionOptions& options);

}  // namespace roadstereo::io
