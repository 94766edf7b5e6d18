#include "flight/flight_health.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

#include "finite_values.hpp"
#include "roadstereo/warning.hpp"
#include "series_health.hpp"

namespace roadstereo::cli {
namespace {

constexpr std::array numbers{&PairHealth::row_offset_px,    &PairHealth::row_correction_px, &PairHealth::row_scale,
                             &PairHealth::row_turn_rad,     &PairHealth::row_error_px,      &PairHealth::row_scatter_px,
                             &PairHealth::distortion_right, &PairHealth::distortion_both,   &PairHealth::bowl_px,
                             &PairHealth::noise_px,         &PairHealth::wave_px,           &PairHealth::gain,
                             &PairHealth::clipped_left,     &PairHealth::clipped_right,     &PairHealth::blur_left_px,
                             &PairHealth::blur_right_px,    &PairHealth::noise_share,       &PairHealth::stripe_share,
                             &PairHealth::blocks_left,      &PairHealth::blocks_right,      &PairHealth::infinity_px,
                             &PairHealth::threshold_sigma};

std::vector<double> known_of(const std::vector<PairHealth>& frames, double PairHealth::*number) {
  std::vector<double> known;
  for (const PairHealth& health : frames) {
    if (std::isfinite(health.*number)) known.push_back(health.*number);
  }
  return known;
}

double median_or_unknown(std::vector<double> values) {
  return values.empty() ? PairHealth::unknown : median(std::move(values));
}

/// Median of what the frames tell; unknown where hardly any of them does.
double typical_of(const std::vector<PairHealth>& frames, double PairHealth::*number) {
  constexpr double min_share = 0.1;
  std::vector<double> known = known_of(frames, number);
  if (static_cast<double>(known.size()) < min_share * static_cast<double>(frames.size())) return PairHealth::unknown;
  return median_or_unknown(std::move(known));
}

}  // namespace

void FlightHealth::add(const io::FlightFrame& frame) {
  ++frames_;
  times_s_.push_back(frame.time_s);
  if (frame.status != io::FrameStatus::good) {
    ++without_result_;
    return;
  }
  of_frames_.push_back(frame.health);
  for (const HealthFinding& finding : frame.health.findings()) ++frames_with_[finding.id];
  for (const std::string& warning : frame.warnings) {
    const std::string_view code = warning_code(warning);
    if (code == "unexpected-pose" || code == "road-anew") ++frames_with_[std::string(code)];
  }
}

PairHealth FlightHealth::typical() const {
  PairHealth health;
  for (double PairHealth::*const number : numbers) health.*number = typical_of(of_frames_, number);
  for (const PairHealth& one : of_frames_) {
    if (!std::isnan(one.spots.left.dirt)) health.spots.left = one.spots.left;
    if (!std::isnan(one.spots.right.dirt)) health.spots.right = one.spots.right;
  }
  return health;
}

double FlightHealth::vibration_px() const {
  return cli::vibration_px(known_of(of_frames_, &PairHealth::row_offset_px));
}

double FlightHealth::missing_pairs() const {
  std::vector<double> steps, untimed;  // between frames with a time, and how many without one lie there
  double last_s = std::numeric_limits<double>::quiet_NaN(), without_time = 0;
  for (const double time_s : times_s_) {
    if (!std::isfinite(time_s) || time_s <= last_s) {  // or a time that cannot be
      ++without_time;
      continue;
    }
    if (std::isfinite(last_s)) {
      steps.push_back(time_s - last_s);
      untimed.push_back(without_time);
    }
    last_s = time_s;
    without_time = 0;
  }
  constexpr double max_missing_periods = 10;  // a longer gap is a pause of the recording
  double missing = 0;
  const double period = median_or_unknown(steps);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const bool is_gap = period > 0 && steps[i] > 1.5 * period && steps[i] <= max_missing_periods * period;
    if (is_gap) missing += std::max(0.0, std::round(steps[i] / period) - 1 - untimed[i]);
  }
  return missing;
}

double FlightHealth::lost_share() const {
  const double missing = missing_pairs(), all = static_cast<double>(frames_) + missing;
  return all > 0 ? (static_cast<double>(without_result_) + missing) / all : 0;
}

std::vector<HealthFinding> FlightHealth::findings() const {
  std::vector<HealthFinding> findings = typical().findings();
  const bool mostly_missing = missing_pairs() > static_cast<double>(without_result_);
  const std::string advice = mostly_missing ? "record to a faster disk" : "frames.csv has the reasons";
  for (const auto& finding : {vibration_finding(vibration_px()), lost_pairs_finding(lost_share(), advice)}) {
    if (finding) findings.push_back(*finding);
  }
  findings.insert(findings.end(), of_trajectory_.begin(), of_trajectory_.end());
  return findings;
}

}  // namespace roadstereo::cli
