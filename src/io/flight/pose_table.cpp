#include "roadstereo/io/pose_table.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/degrees.hpp"
#include "io/csv.hpp"
#include "roadstereo/series_smoother.hpp"

namespace roadstereo::io {
namespace {

/// Remove the jumps of an angle known up to multiples of π, as that of a line is.
void unwrap(std::vector<SeriesSample>& samples) {
  double last = 0;
  for (SeriesSample& sample : samples) {
    if (!std::isfinite(sample.value)) continue;
    sample.value = last + std::remainder(sample.value - last, std::numbers::pi);
    last = sample.value;
  }
}

/// Return the angle in (−π/2, π/2].
double wrap(double angle) {
  const double wrapped = std::remainder(angle, std::numbers::pi);
  return wrapped == -std::numbers::pi / 2 ? -wrapped : wrapped;
}

}  // namespace

void PoseTable::add(const FlightFrame& frame) {
  const double roll_rad = frame.roll_observable ? frame.roll_rad : FlightFrame::unknown;
  poses_.push_back({frame.index,
                    frame.time_s,
                    {roll_rad, frame.roll_stderr_rad},
                    {frame.pitch_rad, frame.pitch_stderr_rad},
                    {frame.height_m, frame.height_stderr_m}});
}

std::string PoseTable::csv() const {
  const bool timed = std::all_of(poses_.begin(), poses_.end(), [](const Pose& p) { return std::isfinite(p.time_s); });
  const auto series = [&](Measurement Pose::*quantity) {
    std::vector<SeriesSample> samples;
    for (std::size_t k = 0; k < poses_.size(); ++k) {
      const Measurement& measured = poses_[k].*quantity;
      samples.push_back({timed ? poses_[k].time_s : static_cast<double>(k), measured.value, measured.std_error});
    }
    return samples;
  };
  std::vector<SeriesSample> roll = series(&Pose::roll_rad);
  unwrap(roll);
  const std::vector<Measurement> rolls = smooth_series(roll), pitches = smooth_series(series(&Pose::pitch_rad)),
                                 heights = smooth_series(series(&Pose::height_m));
  std::string text = "frame,time_s,roll_deg,roll_stderr_deg,pitch_deg,pitch_stderr_deg,height_m,height_stderr_m\r\n";
  for (std::size_t k = 0; k < poses_.size(); ++k) {
    CsvLine line;
    line.add(poses_[k].frame).add(poses_[k].time_s);
    line.add(to_degrees(wrap(rolls[k].value))).add(to_degrees(rolls[k].std_error));
    line.add(to_degrees(pitches[k].value)).add(to_degrees(pitches[k].std_error));
    text += line.add(heights[k].value).add(heights[k].std_error).end();
  }
  return text;
}

}  // namespace roadstereo::io
