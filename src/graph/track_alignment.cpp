#include "graph/track_alignment.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "core/order_statistics.hpp"

namespace roadstereo {
namespace {

using Point = Eigen::Vector2d;

/// A frame and the fix at its time, horizontally.
struct Match {
  Point frame, fix;
  double frame_z = 0, fix_z = 0;
  double sd_m = 0;  ///< expected distance, per axis
  bool has_z = false;
};

/// Turn about the vertical and shift.
struct PlaneMotion {
  double cosine = 1, sine = 0;
  Point from = Point::Zero(), to = Point::Zero();  ///< centroids

  Point operator()(const Point& p) const {
    const Point d = p - from;
    return to + Point(cosine * d.x() - sine * d.y(), sine * d.x() + cosine * d.y());
  }
};

PlaneMotion least_squares(const std::vector<Match>& matches, const std::vector<char>& taken) {
  PlaneMotion motion;
  double count = 0;
  for (std::size_t i = 0; i < matches.size(); ++i) {
    if (!taken[i]) continue;
    motion.from += matches[i].frame;
    motion.to += matches[i].fix;
    ++count;
  }
  motion.from /= count;
  motion.to /= count;
  double along = 0, across = 0;
  for (std::size_t i = 0; i < matches.size(); ++i) {
    if (!taken[i]) continue;
    const Point a = matches[i].frame - motion.from, b = matches[i].fix - motion.to;
    along += a.dot(b);
    across += a.x() * b.y() - a.y() * b.x();
  }
  const double length = std::hypot(along, across);
  if (length > 0) motion.cosine = along / length, motion.sine = across / length;
  return motion;
}

std::vector<double> distances(const std::vector<Match>& matches, const PlaneMotion& motion) {
  std::vector<double> result;
  result.reserve(matches.size());
  for (const Match& match : matches) result.push_back((motion(match.frame) - match.fix).norm());
  return result;
}

/// How a piece fits.
struct PieceFit {
  PlaneMotion motion;
  std::vector<double> distances_m;
};

PieceFit fit_piece(const std::vector<Match>& matches) {
  constexpr double outlying = 3;  // medians
  std::vector<char> taken(matches.size(), 1);
  PieceFit fit{least_squares(matches, taken), {}};
  std::vector<double> sorted = fit.distances_m = distances(matches, fit.motion);
  const double limit = outlying * upper_median(sorted);
  for (std::size_t i = 0; i < matches.size(); ++i) taken[i] = fit.distances_m[i] <= limit ? 1 : 0;
  fit.motion = least_squares(matches, taken);
  fit.distances_m = distances(matches, fit.motion);
  return fit;
}

/// Largest distance of a frame from the mean of its piece.
double extent(const std::vector<Match>& matches) {
  Point mean = Point::Zero();
  for (const Match& match : matches) mean += match.frame / static_cast<double>(matches.size());
  double largest = 0;
  for (const Match& match : matches) largest = std::max(largest, (match.frame - mean).norm());
  return largest;
}

/// Fit at one time offset.
struct OffsetFit {
  double cost = INFINITY;
  std::size_t matched = 0;
  double median_m = 0;   ///< of the distances
  double median_sd = 0;  ///< ... in their standard errors
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
    std::vector<double> times_s(frames.size());
    std::transform(frames.begin(), frames.end(), times_s.begin(), [](const auto& frame) { return frame.time_s; });
    independent_ = std::max(1.0, recorded_s(times_s, options.max_fix_gap_s) / std::max(options.fix_correlation_s, 1.0));
  }

  /// The best time offset: a coarse search, then a finer one around the best.
  double best_offset(bool mirrored) const {
    constexpr double coarse_s = 0.5, fine_s = 0.02;
    const double limit = options_.max_time_offset_s;
    const double near = search(0, limit, coarse_s, mirrored);
    return std::clamp(search(near, std::min(coarse_s, limit), fine_s, mirrored), -limit, limit);
  }

  /// The cost is −2 log of the likelihood for fixes of unknown noise, and of the expected time offset.
  OffsetFit fit(double offset_s, bool mirrored) const {
    constexpr double least_m = 0.01;  // noise of the best receivers
    constexpr double outlying = 3;    // medians
    std::vector<double> all, in_sd;
    for (std::size_t piece = 0; piece < level_.size(); ++piece) {
      const std::vector<Match> matches = matches_of(piece, offset_s, mirrored);
      if (!anchors(matches)) continue;
      const PieceFit fitted = fit_piece(matches);
      for (std::size_t i = 0; i < matches.size(); ++i) in_sd.push_back(fitted.distances_m[i] / matches[i].sd_m);
      all.insert(all.end(), fitted.distances_m.begin(), fitted.distances_m.end());
    }
    OffsetFit result;
    result.matched = all.size();
    if (all.empty()) return result;
    result.median_m = upper_median(all);
    result.median_sd = upper_median(in_sd);
    const double most = outlying * result.median_m;
    double squares = 0;
    for (const double distance_m : all) squares += std::min(distance_m * distance_m, most * most);
    const double relative = offset_s / options_.time_offset_sd_s;
    result.cost = 2 * independent_ * std::log(squares / static_cast<double>(all.size()) + least_m * least_m) +
                  relative * relative;
    return result;
  }

  std::vector<std::optional<GraphPose>> pieces(double offset_s) const {
    std::vector<std::optional<GraphPose>> result(level_.size());
    for (std::size_t piece = 0; piece < level_.size(); ++piece) {
      const std::vector<Match> matches = matches_of(piece, offset_s, false);
      if (!anchors(matches)) continue;
      const PlaneMotion motion = fit_piece(matches).motion;
      std::vector<double> lifts;
      for (const Match& match : matches) {
        if (match.has_z) lifts.push_back(match.fix_z - match.frame_z);
      }
      const Eigen::Quaterniond turn(
          Eigen::AngleAxisd(std::atan2(motion.sine, motion.cosine), Eigen::Vector3d::UnitZ()));
      const Point shift = motion(Point::Zero());
      const double lift = lifts.empty() ? 0 : upper_median(lifts);
      result[piece] = GraphPose{{shift.x(), shift.y(), lift}, turn * *level_[piece]};
    }
    return result;
  }

  double largest_extent(double offset_s) const {
    double largest = 0;
    for (std::size_t piece = 0; piece < level_.size(); ++piece) {
      const std::vector<Match> matches = matches_of(piece, offset_s, false);
      if (!matches.empty()) largest = std::max(largest, extent(matches));
    }
    return largest;
  }

  bool has_vertical() const {
    return std::any_of(level_.begin(), level_.end(), [](const auto& level) { return level.has_value(); });
  }

 private:
  /// A piece has a direction if it is longer than its positions are uncertain.
  static bool anchors(const std::vector<Match>& matches) {
    return matches.size() >= 2 && extent(matches) > matches.front().sd_m;
  }

  std::vector<Match> matches_of(std::size_t piece, double offset_s, bool mirrored) const {
    std::vector<Match> matches;
    if (!level_[piece]) return matches;
    for (const TimedPosition& frame : frames_[piece]) {
      const double time_s = frame.time_s + offset_s;
      const std::optional<std::size_t> segment = curve_.segment(time_s);
      if (!segment) continue;
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

  double search(double centre_s, double reach_s, double step_s, bool mirrored) const {
    const auto steps = static_cast<int>(reach_s / step_s);
    std::vector<std::pair<double, OffsetFit>> fits;
    std::size_t most = 0;
    for (int i = -steps; i <= steps; ++i) {
      fits.emplace_back(centre_s + i * step_s, fit(centre_s + i * step_s, mirrored));
      most = std::max(most, fits.back().second.matched);
    }
    double best_s = centre_s, best = INFINITY;
    for (const auto& [offset_s, fit] : fits) {  // an offset must not win by leaving frames out
      if (2 * fit.matched < most || !(fit.cost < best)) continue;
      best = fit.cost;
      best_s = offset_s;
    }
    return best_s;
  }

  std::vector<std::vector<TimedPosition>> frames_;  ///< of each piece
  const FixCurve& curve_;
  const PoseGraphOptions& options_;
  std::vector<std::optional<Eigen::Quaterniond>> level_;  ///< world of each piece to one whose z axis is the vertical
  double independent_ = 1;                                ///< fixes whose errors differ
};

/// Why fixes are refused; empty if they fit.
std::string refusal(const Aligner& aligner, double offset_s) {
  constexpr double most_sd = 3.5;  // three times the median of a distance in two dimensions
  constexpr double better = 3, noticeable = 0.01;
  const OffsetFit straight = aligner.fit(offset_s, false);
  const OffsetFit mirrored = aligner.fit(aligner.best_offset(true), true);
  std::ostringstream text;
  text.precision(3);
  if (straight.median_m > better * mirrored.median_m &&
      straight.median_m > noticeable * aligner.largest_extent(offset_s)) {
    text << "the positions of the track fit the trajectory only mirrored (" << mirrored.median_m << " m instead of "
         << straight.median_m << " m, median): east and west, or latitude and longitude, may be exchanged";
  } else if (straight.median_sd > most_sd) {
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
