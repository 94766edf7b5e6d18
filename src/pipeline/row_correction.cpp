#include "pipeline/row_correction.hpp"

#include <algorithm>
#include <cmath>

#include "core/format_message.hpp"

namespace roadstereo {
namespace {

constexpr double min_correction_px = 0.05;  // interpolation between rows blurs: less is not worth it

/// The misalignment that makes the offsets of the rows.
Misalignment misalignment_of(const RowOffset& rows, int width, int height,
                             const std::optional<StereoCalibration>& calibration) {
  const double cx = calibration ? calibration->cx_px + calibration->disparity_offset_px : 0.5 * (width - 1);
  const double cy = calibration ? calibration->cy_px : 0.5 * (height - 1);
  return {rows.at(cx, cy), rows.per_column, rows.per_row, cx, cy};
}

/// Whether the misalignments differ by more than the error of `rows`, from which the first one was derived.
bool differ(const Misalignment& measured, const RowAlignment& rows, const Misalignment& last, int width, int height) {
  constexpr double min_std_errors = 5;
  const Misalignment& centre = measured.is_zero() ? last : measured;  // without a correction it has none
  const Misalignment change{measured.rows_px - last.rows_px, measured.turn_rad - last.turn_rad,
                            measured.row_scale - last.row_scale, centre.cx_px, centre.cy_px};
  const double std_error = rows.fit_sigma_px / std::sqrt(rows.points);
  return change.largest_px(width, height) > std::max(min_correction_px, min_std_errors * std_error);
}

}  // namespace

bool rows_are_due(const PipelineState& carried) {
  constexpr int frames_while_known = 100, frames_while_unknown = 10;
  return carried.frames_since_rows >= (carried.rows_known ? frames_while_known : frames_while_unknown);
}

void update_misalignment(const RowAlignment& rows, Rows of, bool correct,
                         const std::optional<StereoCalibration>& calibration, PipelineState& carried) {
  carried.frames_since_rows = 0;
  if (!rows.known()) return;
  Misalignment measured = misalignment_of(rows.fit, carried.width, carried.height, calibration);
  const double largest = measured.largest_px(carried.width, carried.height);
  if (!correct || largest < min_correction_px || largest > Misalignment::max_px) measured = {};
  if (of == Rows::of_new_road || !carried.rows_known ||
      differ(measured, rows, carried.misalignment, carried.width, carried.height)) {
    carried.misalignment = measured;
  }
  carried.rows_known = true;
}

std::string row_warning(const RowAlignment& rows, Rows of) {
  constexpr double max_offset_px = 0.5, max_spread_px = 1;
  if (!rows.known()) {
    if (of == Rows::of_tracked_road) return {};
    return "rows-unknown: the row alignment of the pair could not be measured: " +
           (rows.points < RowAlignment::min_points
                ? format_message(rows.points, " points are too few")
                : format_message("the offsets of ", rows.points, " points scatter by ", rows.fit_sigma_px, " px"));
  }
  if (std::abs(rows.median_px) <= max_offset_px && rows.sigma_px <= max_spread_px) return {};
  return format_message("rows-disagree: the rows of the pair are not aligned: vertical offset ", rows.median_px,
                        " px (median of ", rows.points, " points, spread ", rows.sigma_px, " px); rectify the pair");
}

}  // namespace roadstereo
