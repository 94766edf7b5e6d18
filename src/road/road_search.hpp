#pragma once

#include <cmath>
#include <cstddef>

#include "roadstereo/host_device.hpp"

// How the road is looked for, on the host and on the device.
namespace roadstereo {

inline constexpr int coarse_pixels = 14000;  ///< that the coarse search leaves at least, where the image has them
inline constexpr int min_matches = 40;       ///< below this nothing is known

/// Power of two by which the coarse search downsamples the image.
inline int coarse_factor(int width, int height) {
  int factor = 1;
  while ((width / (2 * factor)) * (height / (2 * factor)) >= coarse_pixels) factor *= 2;
  return factor;
}

/// By how much the fine search downsamples large images.
inline int fine_factor(int width) {
  int factor = 1;
  while (width / (2 * factor) >= 960) factor *= 2;
  return factor;
}

/// How far and in how many places a search around a supposed plane looks. Each first brings the plane near, then
/// measures it where the residuals are small, for a parabola is the more exact the nearer the peak is to a pixel.
struct FineSearch {
  int range_px;
  int places;
};
inline constexpr FineSearch first_search{7, 1000};  ///< the coarse plane is good to a pixel of the shrunk image at best
inline constexpr FineSearch close_search{4, 2500};
inline constexpr FineSearch first_cell_search{7, 4000};
inline constexpr FineSearch close_cell_search{4, 5000};
inline constexpr FineSearch close_search_again{2, 1500};
inline constexpr FineSearch first_search_again{4, 700};  ///< around the last frame's plane

/// Of the search that covers the image evenly: distance of its samples, and how far from the plane it looks, pixels of
/// the shrunk image, as is the tolerance of its RANSAC, three deviations of a cell: a plane through both the road and a
/// pavement is far from most cells.
inline constexpr int even_spacing_px = 5, even_range_px = 7;
inline constexpr double even_tolerance = 0.5;
inline constexpr std::size_t min_even_points = 40;
/// Its plane is taken unless it has less than this share of the evidence of the plane it started from.
inline constexpr double min_even_evidence = 0.75;

/// Of the robust fit after a search. Its window, in pixels of the downsampled image, is narrow enough that a kerb does
/// not pull the plane, and wide enough for a road that is not flat.
inline constexpr int fine_fit_iterations = 50;
inline constexpr double fine_fit_scale = 0.5;

/// The rows of the inliers between these shares count as covered.
inline constexpr double row_p05 = 0.05;
inline constexpr double row_p95 = 0.95;

/// RoadModelEstimate::correlation is this quantile of the correlations on the road.
inline constexpr double correlation_p10 = 0.1;

/// Shares of the residuals near the road that bound its range.
inline constexpr double residual_p01 = 0.01;
inline constexpr double residual_p99 = 0.99;

/// Whether a correspondence is near the road: far enough from it to show damage, bumps and a road that is not flat,
/// not so far that vehicles and houses count.
ROADSTEREO_HD inline bool near_road(double residual, double expected) {
  return expected > 0 && std::fabs(residual) < 4 + 0.12 * expected;
}

}  // namespace roadstereo
