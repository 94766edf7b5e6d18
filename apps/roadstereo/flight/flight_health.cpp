#include "flight/flight_health.hpp"

#include <fmt/core.h>

#include <array>
#include <cmath>
#include <utility>

#include "finite_values.hpp"

namespace roadstereo::cli {
namespace {

constexpr std::array numbers{&PairHealth::row_offset_px,
                             &PairHealth::row_correction_px,
                             &PairHealth::row_scale,
                             &PairHealth::row_turn_rad,
                             &PairHealth::row_error_px,
                             &PairHealth::distortion_right,
                             &PairHealth::distortion_both,
                             &PairHealth::bowl_px,
                             &PairHealth::noise_px,
                             &PairHealth::wave_px,
                             &PairHealth::gain,
                             &PairHealth::clipped_left,
                             &PairHealth::clipped_right,
                             &PairHealth::blur_left_px,
                             &PairHealth::blur_right_px,
                             &PairHealth::noise_share,
                             &PairHealth::blocks_left,
                             &PairHealth::blocks_right,
                             &PairHealth::infinity_px,
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

}  // namespace

void FlightHealth::add(const io::FlightFrame& frame) {
  ++frames_;
  if (std::isfinite(frame.time_s)) times_s_.push_back(frame.time_s);
  if (frame.status != io::FrameStatus::good) {
    ++without_result_;
    return;
  }
  of_frames_.push_back(frame.health);
  for (const HealthFinding& finding : frame.health.findings()) ++frames_with_[finding.id];
}

PairHealth FlightHealth::typical() const {
  PairHealth health;
  for (double PairHealth::*const number : numbers) health.*number = median_or_unknown(known_of(of_frames_, number));
  for (const PairHealth& one : of_frames_) {
    if (!std::isnan(one.spots.left.dirt)) health.spots.left = one.spots.left;
    if (!std::isnan(one.spots.right.dirt)) health.spots.right = one.spots.right;
  }
  return health;
}

double FlightHealth::vibration_px() const {
  constexpr std::size_t min_steps = 10;
  const std::vector<double> offsets = known_of(of_frames_, &PairHealth::row_offset_px);
  std::vector<double> steps;
  for (std::size_t i = 1; i < offsets.size(); ++i) steps.push_back(std::abs(offsets[i] - offsets[i - 1]));
  // The difference of two offsets has twice the variance of one.
  return steps.size() < min_steps ? PairHealth::unknown : 1.4826 * median(steps) / std::sqrt(2.0);
}

double FlightHealth::lost_share() const {
  std::vector<double> periods;
  for (std::size_t i = 1; i < times_s_.size(); ++i) periods.push_back(times_s_[i] - times_s_[i - 1]);
  double missing = 0;
  const double period = median_or_unknown(periods);
  for (const double gap : periods) {
    if (period > 0 && gap > 1.5 * period) missing += std::round(gap / period) - 1;
  }
  const double all = static_cast<double>(frames_) + missing;
  return all > 0 ? (static_cast<double>(without_result_) + missing) / all : 0;
}

std::vector<HealthFinding> FlightHealth::findings() const {
  std::vector<HealthFinding> findings = typical().findings();
  constexpr double max_vibration_px = 0.5, max_lost = 0.01;
  const double vibration = vibration_px(), lost = lost_share();
  if (vibration > max_vibration_px) {
    findings.push_back(
        {"vibration", vibration, max_vibration_px, "px",
         fmt::format("the offset of the rows changes by {:.2f} px from frame to frame (limit {} px): a camera "
                     "vibrates; damp its mount",
                     vibration, max_vibration_px),
         false});
  }
  if (lost > max_lost) {
    findings.push_back(
        {"lost-pairs", lost, max_lost, "",
         fmt::format("{:.1f} % of the pairs are missing or have no result (limit {} %); see the reasons in "
                     "frames.csv, and record to a faster disk",
                     100 * lost, 100 * max_lost),
         false});
  }
  findings.insert(findings.end(), of_trajectory_.begin(), of_trajectory_.end());
  return findings;
}

}  // namespace roadstereo::cli
