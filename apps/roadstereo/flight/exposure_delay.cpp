#include "flight/exposure_delay.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace roadstereo::cli {
namespace {

struct Sample {
  int reference;
  double rate, offset_px, weight;
};

/// Angle about the camera's vertical axis from a rotation of less than a half turn; negative when the rig turns right.
double turn_rad(const std::array<double, 12>& motion) {
  return std::atan2(motion[2], motion[10]);
}

std::vector<Sample> samples_of(const std::vector<FrameLink>& links, const std::map<int, double>& times_s, bool timed) {
  constexpr double spread_px = 0.1;  // of neighbouring links of a street beyond their standard errors, as in odometry
  std::vector<Sample> samples;
  for (const FrameLink& link : links) {
    if (!(link.measured_offset_sd_px > 0)) continue;
    const double duration = timed ? times_s.at(link.to) - times_s.at(link.from) : link.to - link.from;
    const double variance = link.measured_offset_sd_px * link.measured_offset_sd_px + spread_px * spread_px;
    if (duration > 0) {
      samples.push_back({link.from, turn_rad(link.motion) / duration, link.measured_offset_px, 1 / variance});
    }
  }
  return samples;
}

/// Share of the largest turn, a run of samples that turn the same way, of the rotation of all.
double share_of_largest_turn(const std::vector<Sample>& samples) {
  double all = 0, turn = 0, largest = 0;
  bool left = true;
  for (const Sample& sample : samples) {
    const double rotation = sample.weight * sample.rate * sample.rate;
    if ((sample.rate > 0) != left) turn = 0;
    left = sample.rate > 0;
    turn += rotation;
    all += rotation;
    largest = std::max(largest, turn);
  }
  return largest / all;
}

/// Standard error of a sum of scores by blocking: from the sums of batches of successive ones, for the length of batch
/// that gives the largest; two parameters were estimated.
double blocked_error(std::vector<double> scores) {
  constexpr std::size_t min_batches = 8;
  double largest = 0;
  while (scores.size() >= min_batches) {
    double squares = 0;
    for (const double score : scores) squares += score * score;
    const auto count = static_cast<double>(scores.size());
    largest = std::max(largest, std::sqrt(squares * count / (count - 2)));
    std::vector<double> pairs;
    for (std::size_t i = 0; i < scores.size(); ++i) {
      if (i % 2 == 0 && i + 1 < scores.size()) pairs.push_back(0);
      pairs.back() += scores[i];  // the last one takes a score that is left over
    }
    scores = std::move(pairs);
  }
  return largest;
}

}  // namespace

std::optional<HealthFinding> exposure_delay(const std::vector<FrameLink>& links, const std::map<int, double>& times_s,
                                            double focal_px) {
  constexpr double standard_errors = 5;
  constexpr double most_of_one_turn = 0.75;  // what else differs in the one turn of a recording looks like a delay
  constexpr std::size_t min_references = 10;
  const bool timed =
      std::all_of(times_s.begin(), times_s.end(), [](const auto& frame) { return std::isfinite(frame.second); });
  const std::vector<Sample> samples = samples_of(links, times_s, timed);
  double weights = 0, mean_rate = 0, mean_offset = 0, spread = 0, product = 0;
  for (const Sample& sample : samples) {
    weights += sample.weight;
    mean_rate += sample.weight * sample.rate;
    mean_offset += sample.weight * sample.offset_px;
  }
  if (!(weights > 0)) return std::nullopt;
  mean_rate /= weights;
  mean_offset /= weights;
  for (const Sample& sample : samples) {
    spread += sample.weight * (sample.rate - mean_rate) * (sample.rate - mean_rate);
    product += sample.weight * (sample.rate - mean_rate) * (sample.offset_px - mean_offset);
  }
  const double slope = product / spread;
  std::map<int, double> scores;
  for (const Sample& sample : samples) {
    const double residual = sample.offset_px - mean_offset - slope * (sample.rate - mean_rate);
    scores[sample.reference] += sample.weight * (sample.rate - mean_rate) * residual;
  }
  if (!(spread > 0) || scores.size() < min_references) return std::nullopt;
  if (share_of_largest_turn(samples) > most_of_one_turn) return std::nullopt;
  std::vector<double> in_order;
  in_order.reserve(scores.size());
  for (const auto& [reference, score] : scores) in_order.push_back(score);
  const double unit = (timed ? 1000 : 1) / focal_px;
  const double delay = unit * slope, error = unit * blocked_error(std::move(in_order)) / spread;
  if (!(std::abs(delay) > standard_errors * error)) return std::nullopt;
  const char* const name = timed ? "ms" : "frames";
  return HealthFinding{
      "exposure-delay",
      std::abs(delay),
      standard_errors * error,
      name,
      fmt::format("disparities at infinity follow the turn rate: the right camera exposes {:.2f} ± {:.2f} {} {} than "
                  "the left one (limit {:.2f} {}, five standard errors); trigger both at the same moment",
                  std::abs(delay), error, name, delay > 0 ? "later" : "earlier", standard_errors * error, name),
      false};
}

}  // namespace roadstereo::cli
