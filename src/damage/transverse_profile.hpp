#pragma once

#include <vector>

#include "damage/road_surface.hpp"

namespace roadstereo {

/// Spacing of the heights of a transverse profile.
inline constexpr double profile_bin_m = 0.1;

/// A sampled cell: its place on the road and its height about a plane, metres.
struct HeightSample {
  double x, y, height;
};

struct HeightSamples {
  std::vector<HeightSample> all;
  std::vector<HeightSample> ends;  ///< first and last of every row of the image, which is a line on the road
};

/// Sample cells on the road and its relief, as far as a row of pixels covers 0.3 m of road.
HeightSamples sample_heights(const Cells& cells, const SurfaceCoordinates& coordinates, const RoadSurface& surface);

/// A direction of the road, from the y axis of its coordinates, positive towards x.
struct Direction {
  double cosine = 1, sine = 0;

  double across(double x, double y) const { return cosine * x - sine * y; }
  double along(double x, double y) const { return sine * x + cosine * y; }
};

/// Heights on a grid: rows are transverse profiles; NaN where fewer than three samples lie.
struct HeightGrid {
  Direction direction;
  double first_m = 0;  ///< across the road
  Image<double> heights;

  /// Negative before the first one.
  int column(double x, double y) const {
    const double at = (direction.across(x, y) - first_m) * (1 / profile_bin_m);
    return at < 0 ? -1 : static_cast<int>(at);
  }
};

HeightGrid grid_heights(const HeightSamples& samples, const Direction& direction);

/// Transverse profile of all of the road in view.
struct MeanProfile {
  std::vector<double> heights;     ///< metres; NaN where less than half of the road is seen
  std::vector<double> std_errors;  ///< metres
};

/// Fit a sum of a transverse and a longitudinal profile to the heights, alternately, by means, in the end the former by
/// medians, which a pothole does not bend.
MeanProfile fit_profile(const Image<double>& heights);

}  // namespace roadstereo
