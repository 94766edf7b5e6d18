#include "live/camera_path.hpp"

#include <cmath>

namespace roadstereo::cli {

void CameraPath::add(double x_m, double y_m) {
  const std::array<double, 2> at{x_m, y_m};
  if (!kept_.empty()) length_m_ += std::hypot(x_m - last_[0], y_m - last_[1]);
  last_ = at;
  if (!kept_.empty() && std::hypot(x_m - kept_.back()[0], y_m - kept_.back()[1]) < step_m_) return;
  if (kept_.size() == max_points) {
    for (std::size_t i = 1; 2 * i < max_points; ++i) kept_[i] = kept_[2 * i];
    kept_.resize(max_points / 2);
    step_m_ *= 2;
  }
  kept_.push_back(at);
}

void CameraPath::clear() {
  kept_.clear();
  step_m_ = finest_step_m;
  length_m_ = 0;
}

std::vector<std::array<double, 2>> CameraPath::points_m() const {
  std::vector<std::array<double, 2>> points = kept_;
  if (!points.empty() && points.back() != last_) points.push_back(last_);
  return points;
}

}  // namespace roadstereo::cli
