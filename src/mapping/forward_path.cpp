#include "mapping/forward_path.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "roadstereo/road_profile.hpp"

namespace roadstereo {
namespace {

constexpr double min_step_m = 0.02;

double distance(const std::array<double, 2>& a, const std::array<double, 2>& b) {
  return std::hypot(b[0] - a[0], b[1] - a[1]);
}

/// Builds the parts of forward_paths().
class PathParts {
 public:
  using Point = std::array<double, 2>;

  void add(const Point& point) {
    constexpr double max_back_m = 5;  // farther back is another pass
    if (parts_.empty()) parts_.push_back({point});
    const double step_m = distance(parts_.back().back(), point);
    if (step_m < min_step_m) return;
    if (is_ahead(parts_.back(), point)) {
      parts_.back().push_back(point);
      back_.clear();
      return;
    }
    back_.push_back(point);
    if (step_m <= max_back_m) return;
    const std::vector<Point> next = std::exchange(back_, {});
    parts_.push_back({next.front()});
    for (const Point& each : next) add(each);
  }
  std::vector<std::vector<Point>> take() { return std::move(parts_); }

 private:
  static bool is_ahead(const std::vector<Point>& part, const Point& point) {
    if (part.size() < 2) return true;
    const Point &before = part[part.size() - 2], &last = part.back();
    return (point[0] - last[0]) * (last[0] - before[0]) + (point[1] - last[1]) * (last[1] - before[1]) >= 0;
  }

  std::vector<std::vector<Point>> parts_;
  std::vector<Point> back_;  ///< points behind the end of the last part
};

}  // namespace

std::vector<std::vector<std::array<double, 2>>> forward_paths(std::span<const std::array<double, 2>> path) {
  PathParts parts;
  for (const auto& point : path) parts.add(point);
  return parts.take();
}

ForwardPath::ForwardPath(std::span<const std::array<double, 2>> points) {
  const auto parts = forward_paths(points);
  if (parts.empty()) return;
  points_ = parts.front();
  distance_.push_back(0);
  for (std::size_t i = 1; i < points_.size(); ++i) {
    distance_.push_back(distance_.back() + distance(points_[i - 1], points_[i]));
  }
}

/// Index of the point at the end of the step in which a place lies.
std::size_t ForwardPath::end_of_step(double s_m) const {
  const auto next = std::upper_bound(distance_.begin(), distance_.end(), s_m) - distance_.begin();
  return static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(next, 1, std::ssize(distance_) - 1));
}

std::array<double, 2> ForwardPath::point(double s_m) const {
  const std::size_t k = end_of_step(s_m);
  const double share = (s_m - distance_[k - 1]) / (distance_[k] - distance_[k - 1]);
  return {points_[k - 1][0] + share * (points_[k][0] - points_[k - 1][0]),
          points_[k - 1][1] + share * (points_[k][1] - points_[k - 1][1])};
}

PathStation ForwardPath::at(double s_m) const {
  constexpr double half_chord_m = 1;  // directions of single steps are noise
  auto before = point(std::max(0.0, s_m - half_chord_m)), after = point(std::min(length_m(), s_m + half_chord_m));
  if (distance(before, after) < min_step_m) {  // turned on the spot
    before = points_[end_of_step(s_m) - 1];
    after = points_[end_of_step(s_m)];
  }
  const double length = distance(before, after);
  return {s_m, point(s_m), {(after[0] - before[0]) / length, (after[1] - before[1]) / length}};
}

}  // namespace roadstereo
