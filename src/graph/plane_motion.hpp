#pragma once

#include <Eigen/Core>
#include <vector>

namespace roadstereo {

/// A frame and the fix at its time, horizontally.
struct TrackMatch {
  Eigen::Vector2d frame, fix;
  double frame_z = 0, fix_z = 0;
  double sd_m = 0;  ///< expected distance, per axis
  bool has_z = false;
};

/// Turn about the vertical and shift.
struct PlaneMotion {
  double cosine = 1, sine = 0;
  Eigen::Vector2d from = Eigen::Vector2d::Zero(), to = Eigen::Vector2d::Zero();  ///< centroids

  Eigen::Vector2d operator()(const Eigen::Vector2d& p) const {
    const Eigen::Vector2d d = p - from;
    return to + Eigen::Vector2d(cosine * d.x() - sine * d.y(), sine * d.x() + cosine * d.y());
  }
};

/// How frames fit their fixes.
struct PlaneMotionFit {
  PlaneMotion motion;
  std::vector<double> distances_m;  ///< that are left
};

/// Fits a motion by least squares, the second time without distances of more than three medians.
PlaneMotionFit fit_plane_motion(const std::vector<TrackMatch>& matches);

/// Largest distance of a frame from the mean of all.
double extent(const std::vector<TrackMatch>& matches);

/// Root mean square distance from their mean of the frames, and of their fixes.
struct Spread {
  double frames_m = 0, fixes_m = 0;
};
Spread spread(const std::vector<TrackMatch>& matches);

}  // namespace roadstereo
