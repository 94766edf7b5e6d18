#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/parallel.hpp"
#include "core/scratch.hpp"
#include "road/plane_fit.hpp"
#include "roadstereo/road_geometry.hpp"

namespace roadstereo {
namespace {

constexpr int rows_per_band = 64;

/// Sums behind a standard deviation.
struct Spread {
  double n = 0, sum = 0, squares = 0;

  void add(double value) {
    n += 1;
    sum += value;
    squares += value * value;
  }
  void add(const Spread& other) {
    n += other.n;
    sum += other.sum;
    squares += other.squares;
  }
  double deviation() const { return n > 0 ? std::sqrt(std::max(squares / n - sum / n * (sum / n), 0.0)) : 0; }
};

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
  auto lowest = scratch_vector(static_cast<std::size_t>(height), std::numeric_limits<float>::infinity());
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

TransformedSpread measure_spread(ImageView<const float> transformed, double delta_t, int threads) {
  constexpr double narrowest_limit_px = 1.0;
  constexpr double nearest_px = 3.0;
  auto residuals = scratch_vector<double>();
  const int step = std::max(1, static_cast<int>(std::sqrt(static_cast<double>(transformed.pixels()) / 12000)));
  for (int v = step / 2; v < transformed.height(); v += step) {
    for (int u = step / 2; u < transformed.width(); u += step) {
      if (!std::isnan(transformed(u, v))) residuals.push_back(transformed(u, v) - delta_t);
    }
  }
  // What stands on the road or beside it must not widen the limit: first only what is near counts.
  std::erase_if(residuals, [](double r) { return std::abs(r) > nearest_px; });
  const double limit = std::max(3 * normal_from_median * median_magnitude(residuals), narrowest_limit_px);

  struct Row {
    Spread all, road;
  };
  auto rows = scratch_vector<Row>(static_cast<std::size_t>(transformed.height()));
  parallel_rows(transformed.height(), rows_per_band, threads, [&](int first, int last, int) {
    for (int v = first; v < last; ++v) {
      const float* values = transformed.row(v);
      Row& row = rows[static_cast<std::size_t>(v)];
      for (int u = 0; u < transformed.width(); ++u) {
        const double r = values[u] - delta_t;
        if (std::isnan(r)) continue;
        row.all.add(r);
        if (std::abs(r) <= limit) row.road.add(r);
      }
    }
  });
  Spread all, road;
  for (const Row& row : rows) {
    all.add(row.all);
    road.add(row.road);
  }
  return {road.deviation(), all.deviation(), all.n > 0 ? road.n / all.n : 0};
}

}  // namespace roadstereo
