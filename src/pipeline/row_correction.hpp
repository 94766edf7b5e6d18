#pragma once

#include <optional>
#include <string>

#include "roadstereo/alignment.hpp"
#include "roadstereo/calibration.hpp"
#include "roadstereo/pipeline.hpp"

namespace roadstereo {

/// Road with which the rows of a pair are measured.
enum class Rows { of_new_road, of_tracked_road };

/// Whether the rows are to be measured although the road is tracked: a mount may creep, and if an earlier measurement
/// failed, a better frame may succeed.
bool rows_are_due(const PipelineState& carried);

/// Takes a measurement of the vertical offset of a pair of `carried.width`×`carried.height` pixels into the state:
/// `misalignment` is what is to be corrected of it, nothing without `correct`. The previous one is kept if the
/// measurement failed, and on a tracked road also if it does not differ significantly.
void update_misalignment(const RowAlignment& rows, Rows of, bool correct,
                         const std::optional<StereoCalibration>& calibration, PipelineState& carried);

/// What a user should know of the rows of a pair, as a warning; empty: nothing.
std::string row_warning(const RowAlignment& rows, Rows of);

}  // namespace roadstereo
