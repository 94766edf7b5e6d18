#include "graph/track_alignment.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "core/order_statistics.hpp"
#include "graph/plane_motion.hpp"

namespace roadstereo {
namespace {

/// Sums over what is left of successive matches.
struct Correlation {
  double product = 0, squares = 0;

  void add(const std::vector<TrackMatch>& matches, const PlaneMotion& motion, double most_m) {
    Eigen::Vector2d last = Eigen::Vector2d::Zero();
    for (const TrackMatch& match : matches) {
      Eigen::Vector2d rest = motion(match.frame) - match.fix;
      rest *= std::min(1.0, most_m / std::max(rest.norm(), 1e-12));
      product += rest.dot(last);
      squares += rest.squaredNorm();
      last = rest;
    }
  }

  /// How many of `count` are independent, for a first-order autoregression.
  double independent(double count) const {
    const double correlation = squares > 0 ? std::clamp(product / squares, 0.0, 1.0) : 0;
    return std::max(1.0, count * (1 - correlation) / (1 + correlation));
  }
};

/// Fit at one time offset.
struct OffsetFit {
  double mean_square_m2 = 0;  ///< of the distances, with the noise of the best receivers
  double independent = 1;     ///< matches whose distances are independent
  std::size_t matched = 0;
  double median_m = 0;   ///< of the distances
  double median_sd = 0;  ///< ... in their standard errors

  bool fits() const {
    constexpr double most_sd = 3.5;  // three times the median of a distance in two dimensions
    return median_sd <= most_sd;
  }
};

/// Times by the receiver's clock.
struct Interval {
  double from_s = -INFINITY, to_s = INFINITY;
};

class Aligner {
 public:
  Aligner(const std::vector<TimedPosition>& frames, const std::vector<std::optional<Eigen::Vector3d>>& up,
          const FixCurve& curve, const PoseGraphOptions& options)
      : frames_(up.size()), curve_(curve), options_(options), level_(up.size()) {
    for (const TimedPosition& frame : frames) frames_[frame.piece].push_back(frame);
    for (std::size_t i = 0; i < up.size(); ++i) {
      if (up[i]) level_[i] = Eigen::Quaterniond::FromTwoVectors(*up[i], Eigen::Vector3d::UnitZ());
    }
    if (frames.empty()) return;
    const auto ends = std::minmax_element(frames.begin(), frames.end(),
                                          [](const auto& one, const auto& other) { return one.time_s < other.time_s; });
    recorded_ = {ends.first->time_s, ends.second->time_s};
  }

  /// The time offset: 0, or, if that leaves out more than half of the frames that can have a position, the nearest to
  /// it that does not. As long as another one is far more likely, or if it does not fit, the most likely one: a coarse
  /// search, then a finer one around the best.
  double best_offset(bool mirrored) const {
    constexpr double coarse_s = 0.25, fine_s = 0.02;
    constexpr int most_steps = 5;
    const double limit = options_.max_time_offset_s;
    const std::vector<double> coarse = grid(0, limit, coarse_s);
    std::size_t most = 0;
    for (const double offset_s : coarse) most = std::max(most, fit(offset_s, mirrored).matched);
    double best_s = INFINITY;
    for (const double offset_s : coarse) {
      if (2 * fit(offset_s, mirrored).matched >= most && std::abs(offset_s) < std::abs(best_s)) best_s = offset_s;
    }
    for (int step = 0; step < most_steps; ++step) {
      const bool any = step == 0 && !fit(best_s, mirrored).fits();
      const double near_s = likeliest(coarse, best_s, most, mirrored, any);
      const double finer_s = likeliest(grid(near_s, std::min(coarse_s, limit), fine_s), best_s, most, mirrored, any);
      if (finer_s == best_s) break;
      best_s = std::clamp(finer_s, -limit, limit);
    }
    return best_s;
  }

  OffsetFit fit(double offset_s, bool mirrored, const Interval& interval = {}) const {
    constexpr double least_m = 0.01;  // noise of the best receivers
    constexpr double outlying = 3;    // medians
    std::vector<double> all, in_sd;
    Correlation correlation;
    for (std::size_t piece = 0; piece < level_.size(); ++piece) {
      const std::vector<TrackMatch> matches = matches_of(piece, offset_s, mirrored, interval);
      if (!anchors(matches)) continue;
      const PlaneMotionFit fitted = fit_plane_motion(matches);
      for (std::size_t i = 0; i < matches.size(); ++i) in_sd.push_back(fitted.distances_m[i] / matches[i].sd_m);
      all.insert(all.end(), fitted.distances_m.begin(), fitted.distances_m.end());
      std::vector<double> sorted = fitted.distances_m;
      correlation.add(matches, fitted.motion, outlying * upper_median(sorted));
    }
    OffsetFit result;
    result.matched = all.size();
    if (all.empty()) return result;
    result.median_m = upper_median(all);
    result.median_sd = upper_median(in_sd);
    const double most = outlying * result.median_m;
    double squares = 0;
    for (const double distance_m : all) squares += std::min(distance_m * distance_m, most * most);
    const auto count = static_cast<double>(all.size());
    result.mean_square_m2 = squares / count + least_m * least_m;
    result.independent = correlation.independent(count);
    return result;
  }

  std::vector<std::optional<GraphPose>> pieces(double offset_s) const {
    std::vector<std::optional<GraphPose>> result(level_.size());
    for (std::size_t piece = 0; piece < level_.size(); ++piece) {
      const std::vector<TrackMatch> matches = matches_of(piece, offset_s, false);
      if (!anchors(matches)) continue;
      const PlaneMotion motion = fit_plane_motion(matches).motion;
      std::vector<double> lifts;
      for (const TrackMatch& match : matches) {
        if (match.has_z) lifts.push_back(match.fix_z - match.frame_z);
      }
      const Eigen::Quaterniond turn(
          Eigen::AngleAxisd(std::atan2(motion.sine, motion.cosine), Eigen::Vector3d::UnitZ()));
      const Eigen::Vector2d shift = motion(Eigen::Vector2d::Zero());
      const double lift = lifts.empty() ? 0 : upper_median(lifts);
      result[piece] = GraphPose{{shift.x(), shift.y(), lift}, turn * *level_[piece]};
    }
    return result;
  }

  double largest_extent(double offset_s) const {
    double largest = 0;
    for (std::size_t piece = 0; piece < level_.size(); ++piece) {
      const std::vector<TrackMatch> matches = matches_of(piece, offset_s, false);
      if (!matches.empty()) largest = std::max(largest, extent(matches));
    }
    return largest;
  }

  /// Of the pieces that the fixes anchor the one along which they move most.
  Spread liveliest_spread(double offset_s) const {
    Spread liveliest;
    for (std::size_t piece = 0; piece < level_.size(); ++piece) {
      const std::vector<TrackMatch> matches = matches_of(piece, offset_s, false);
      if (!anchors(matches)) continue;
      const Spread one = spread(matches);
      if (one.fixes_m * liveliest.frames_m >= liveliest.fixes_m * one.frames_m) liveliest = one;
    }
    return liveliest;
  }

  bool has_vertical() const {
    return std::any_of(level_.begin(), level_.end(), [](const auto& level) { return level.has_value(); });
  }

 private:
  /// A piece has a direction if it is longer than its positions are uncertain.
  static bool anchors(const std::vector<TrackMatch>& matches) {
    if (matches.size() < 2) return false;
    std::vector<double> sd_m(matches.size());
    std::transform(matches.begin(), matches.end(), sd_m.begin(), [](const TrackMatch& match) { return match.sd_m; });
    return extent(matches) > upper_median(sd_m);
  }

  std::vector<TrackMatch> matches_of(std::size_t piece, double offset_s, bool mirrored,
                                     const Interval& interval = {}) const {
    std::vector<TrackMatch> matches;
    if (!level_[piece]) return matches;
    for (const TimedPosition& frame : frames_[piece]) {
      const double time_s = frame.time_s + offset_s;
      const std::optional<std::size_t> segment = curve_.segment(time_s);
      if (!segment || !(time_s >= interval.from_s && time_s <= interval.to_s)) continue;
      const Eigen::Vector3d level = *level_[piece] * frame.position, fix = curve_.at(*segment, time_s);
      const PositionFix& before = curve_.fixes()[*segment];
      matches.push_back({level.head<2>(),
                         {mirrored ? -fix.x() : fix.x(), fix.y()},
                         level.z(),
                         fix.z(),
                         std::hypot(before.horizontal_sd_m, options_.lever_arm_sd_m),
                         !std::isnan(before.position_m[2])});
    }
    return matches;
  }

  static std::vector<double> grid(double centre_s, double reach_s, double step_s) {
    const auto steps = static_cast<int>(reach_s / step_s);
    std::vector<double> offsets_s;
    for (int i = -steps; i <= steps; ++i) offsets_s.push_back(centre_s + i * step_s);
    return offsets_s;
  }

  /// Of the offsets that match at least half of `most` frames the one that is likeliest; the expected one if none is
  /// far more likely, unless `any` other one is welcome.
  double likeliest(const std::vector<double>& offsets_s, double expected_s, std::size_t most, bool mirrored,
                   bool any) const {
    double best_s = expected_s;
    Gain best{-INFINITY, 0, true};
    for (const double offset_s : offsets_s) {
      if (2 * fit(offset_s, mirrored).matched < most) continue;
      const Gain gain = gain_of(offset_s, expected_s, mirrored);
      if (!any && !(gain.value > gain.significant)) continue;
      const bool comparable = any || best_s == expected_s || gain.paired == best.paired;
      if (comparable ? !(gain.value > best.value) : !gain.paired) continue;
      best = gain;
      best_s = offset_s;
    }
    return best_s;
  }

  /// Twice the logarithm of how many times likelier an offset is, and what chance does not reach.
  struct Gain {
    double value, significant;
    bool paired;  ///< on the same fixes; goes first
  };

  /// Compares an offset with the expected one, for fixes of unknown noise: on the fixes that both have frames for, so
  /// that leaving bad ones out is no gain; each on its own, as two samples, where those are less than half.
  Gain gain_of(double offset_s, double expected_s, bool mirrored) const {
    constexpr double paired = 18;      // one degree of freedom, a hundred offsets: 99.7 %
    constexpr double two_samples = 9;  // 4.5 standard deviations, 2 √ν, of the logarithm of F(ν, ν) times ν
    const Interval common{recorded_.from_s + std::max(offset_s, expected_s),
                          recorded_.to_s + std::min(offset_s, expected_s)};
    OffsetFit expected = fit(expected_s, mirrored, common), other = fit(offset_s, mirrored, common);
    const OffsetFit all_expected = fit(expected_s, mirrored), all_other = fit(offset_s, mirrored);
    const bool apart =
        2 * std::min(expected.matched, other.matched) < std::min(all_expected.matched, all_other.matched);
    if (apart) expected = all_expected, other = all_other;
    const double freedom = 2 * other.independent;  // a wrong offset leaves what is alike in neighbours
    const double sd_s = options_.time_offset_sd_s;
    return {freedom * std::log(expected.mean_square_m2 / other.mean_square_m2) -
                (offset_s * offset_s - expected_s * expected_s) / (sd_s * sd_s),
            apart ? std::max(paired, two_samples * std::sqrt(freedom)) : paired, !apart};
  }

  std::vector<std::vector<TimedPosition>> frames_;  ///< of each piece
  const FixCurve& curve_;
  const PoseGraphOptions& options_;
  std::vector<std::optional<Eigen::Quaterniond>> level_;  ///< world of each piece to one whose z axis is the vertical
  Interval recorded_{0, 0};                               ///< first and last frame, by the camera's clock
};

/// Why fixes are refused; empty if they fit.
std::string refusal(const Aligner& aligner, double offset_s) {
  constexpr double better = 3, noticeable = 0.01, standing = 0.25;
  const OffsetFit straight = aligner.fit(offset_s, false);
  const OffsetFit mirrored = aligner.fit(aligner.best_offset(true), true);
  const Spread spread = aligner.liveliest_spread(offset_s);
  std::ostringstream text;
  text.precision(3);
  if (spread.fixes_m < standing * spread.frames_m) {
    text << "the track stands still while the camera moves: its positions are within " << spread.fixes_m
         << " m of their mean, those of the camera within " << spread.frames_m << " m";
  } else if (straight.median_m > better * mirrored.median_m &&
             straight.median_m > noticeable * aligner.largest_extent(offset_s)) {
    text << "the positions of the track fit the trajectory only mirrored (" << mirrored.median_m << " m instead of "
         << straight.median_m << " m, median): east and west, or latitude and longitude, may be exchanged";
  } else if (!straight.fits()) {
    text << "the positions of the track do not fit the trajectory: they are " << straight.median_m
         << " m off (median) after the best turn, shift and time offset, " << straight.median_sd << " standard errors";
  }
  return text.str();
}

}  // namespace

double recorded_s(std::span<const double> times_s, double max_gap_s) {
  double sum_s = 0, last_s = std::numeric_limits<double>::quiet_NaN();
  for (const double time_s : times_s) {
    if (std::isnan(time_s)) continue;
    const double step_s = time_s - last_s;
    if (step_s > 0) sum_s += std::min(step_s, max_gap_s);
    last_s = time_s;
  }
  return sum_s;
}

TrackAlignment align_to_track(const std::vector<TimedPosition>& frames,
                              const std::vector<std::optional<Eigen::Vector3d>>& up, const FixCurve& curve,
                              const PoseGraphOptions& options) {
  const Aligner aligner(frames, up, curve, options);
  TrackAlignment alignment;
  if (!aligner.has_vertical()) {
    alignment.unused = "no frame has a road, so that the vertical of the trajectory is unknown";
    return alignment;
  }
  alignment.time_offset_s = aligner.best_offset(false);
  if (aligner.fit(alignment.time_offset_s, false).matched == 0) {
    alignment.unused =
        "no piece of the trajectory has positions at its times over a longer way than their standard error";
    return alignment;
  }
  alignment.unused = refusal(aligner, alignment.time_offset_s);
  alignment.contradicts = !alignment.unused.empty();
  if (!alignment.contradicts) alignment.pieces = aligner.pieces(alignment.time_offset_s);
  return alignment;
}

}  // namespace roadstereo
