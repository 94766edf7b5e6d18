#include "graph/plane_motion.hpp"

#include <algorithm>
#include <cmath>

#include "core/order_statistics.hpp"

namespace roadstereo {
namespace {

PlaneMotion least_squares(const std::vector<TrackMatch>& matches, const std::vector<char>& taken) {
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
    const Eigen::Vector2d a = matches[i].frame - motion.from, b = matches[i].fix - motion.to;
    along += a.dot(b);
    across += a.x() * b.y() - a.y() * b.x();
  }
  const double length = std::hypot(along, across);
  if (length > 0) motion.cosine = along / length, motion.sine = across / length;
  return motion;
}

std::vector<double> distances(const std::vector<TrackMatch>& matches, const PlaneMotion& motion) {
  std::vector<double> result;
  result.reserve(matches.size());
  for (const TrackMatch& match : matches) result.push_back((motion(match.frame) - match.fix).norm());
  return result;
}

}  // namespace

PlaneMotionFit fit_plane_motion(const std::vector<TrackMatch>& matches) {
  constexpr double outlying = 3;  // medians
  std::vector<char> taken(matches.size(), 1);
  PlaneMotionFit fit{least_squares(matches, taken), {}};
  std::vector<double> sorted = fit.distances_m = distances(matches, fit.motion);
  const double limit = outlying * upper_median(sorted);
  for (std::size_t i = 0; i < matches.size(); ++i) taken[i] = fit.distances_m[i] <= limit ? 1 : 0;
  fit.motion = least_squares(matches, taken);
  fit.distances_m = distances(matches, fit.motion);
  return fit;
}

double extent(const std::vector<TrackMatch>& matches) {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const TrackMatch& match : matches) mean += match.frame / static_cast<double>(matches.size());
  double largest = 0;
  for (const TrackMatch& match : matches) largest = std::max(largest, (match.frame - mean).norm());
  return largest;
}

Spread spread(const std::vector<TrackMatch>& matches) {
  Eigen::Vector2d frame = Eigen::Vector2d::Zero(), fix = Eigen::Vector2d::Zero();
  const auto count = static_cast<double>(matches.size());
  for (const TrackMatch& match : matches) frame += match.frame / count, fix += match.fix / count;
  double of_frames = 0, of_fixes = 0;
  for (const TrackMatch& match : matches) {
    of_frames += (match.frame - frame).squaredNorm() / count;
    of_fixes += (match.fix - fix).squaredNorm() / count;
  }
  return {std::sqrt(of_frames), std::sqrt(of_fixes)};
}

}  // namespace roadstereo
