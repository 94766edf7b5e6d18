#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/parallel.hpp"
#include "road/plane_fit.hpp"
#include "roadstereo/road_geometry.hpp"

namespace roadstereo {
namespace {

constexpr int rows_per_band = 64;

/// ℓ(p) − α0 + α1 (u sin ψ − v cos ψ): height above (or depth below) the road, in pixels of disparity.
void subtract_road(ImageView<const float> disparity, const RoadModel& plane, int v, float* out) {
  const float* in = disparity.row(v);
  const double row = plane.a0 + plane.a1 * v;
  for (int u = 0; u < disparity.width(); ++u) out[u] = static_cast<float>(in[u] - (row + plane.a2 * u));
}

}  // namespace

double transform_disparity(ImageView<const float> disparity, const RoadGeometry& geometry, double least_delta_t,
                           const RoadGeometryOptions& options, int threads, Image<float>& transformed) {
  const int height = disparity.height();
  transformed.resize(disparity.width(), height);
  std::vector<float> lowest(static_cast<std::size_t>(height), std::numeric_limits<float>::infinity());
  parallel_rows(height, rows_per_band, threads, [&](int first, int last, int) {
    for (int v = first; v < last; ++v) {
      float* out = transformed.row(v);
      subtract_road(disparity, geometry.plane, v, out);
      for (int u = 0; u < disparity.width(); ++u) {
        if (out[u] < lowest[static_cast<std::size_t>(v)]) lowest[static_cast<std::size_t>(v)] = out[u];
      }
    }
  });
  double delta_t = options.delta_t_px;
  if (delta_t < 0) {
    const double smallest = *std::min_element(lowest.begin(), lowest.end());
    const double needed = std::isfinite(smallest) ? std::floor(-smallest) + 1 : 0;
    delta_t = std::max(std::ceil(least_delta_t), needed);
  }
  parallel_rows(height, rows_per_band, threads, [&](int first, int last, int) {
    for (int v = first; v < last; ++v) {
      float* out = transformed.row(v);
      for (int u = 0; u < disparity.width(); ++u) out[u] += static_cast<float>(delta_t);
    }
  });
  return delta_t;
}

TransformedSpread measure_spread(ImageView<const float> transformed, double delta_t) {
  constexpr double narrowest_limit_px = 1.0;
  constexpr double nearest_px = 3.0;
  std::vector<double> residuals;
  const int step = std::max(1, static_cast<int>(std::sqrt(static_cast<double>(transformed.pixels()) / 12000)));
  for (int v = step / 2; v < transformed.height(); v += step) {
    for (int u = step / 2; u < transformed.width(); u += step) {
      if (!std::isnan(transformed(u, v))) residuals.push_back(transformed(u, v) - delta_t);
    }
  }
  // What stands on the road or beside it must not widen the limit: first only what is near counts.
  std::erase_if(residuals, [](double r) { return std::abs(r) > nearest_px; });
  const double limit = std::max(3 * normal_from_median * median_magnitude(residuals), narrowest_limit_px);

  double n = 0, sum = 0, squares = 0, road_n = 0, road_sum = 0, road_squares = 0;
  for (int v = 0; v < transformed.height(); ++v) {
    for (int u = 0; u < transformed.width(); ++u) {
      const double r = transformed(u, v) - delta_t;
      if (std::isnan(r)) continue;
      n += 1;
      sum += r;
      squares += r * r;
      if (std::abs(r) > limit) continue;
      road_n += 1;
      road_sum += r;
      road_squares += r * r;
    }
  }
  TransformedSpread spread;
  if (n > 0) spread.all_px = std::sqrt(std::max(squares / n - sum / n * (sum / n), 0.0));
  if (road_n > 0) {
    spread.road_px = std::sqrt(std::max(road_squares / road_n - road_sum / road_n * (road_sum / road_n), 0.0));
    spread.road_share = road_n / n;
  }
  return spread;
}

}  // namespace roadstereo
