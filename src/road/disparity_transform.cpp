#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "core/order_statistics.hpp"
#include "core/parallel.hpp"
#include "core/scratch.hpp"
#include "road/plane_fit.hpp"
#include "road/row_spread.hpp"
#include "road/transformed.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/roll.hpp"

namespace roadstereo {
namespace {

constexpr int rows_per_band = 64;
void subtract_road(ImageView<const float> disparity, const DisparityPlane& plane, int v, float* out) {
  const float* in = disparity.row(v);
  const RowLine road = row_line(plane, v, 0);
  for (int u = 0; u < disparity.width(); ++u) out[u] = above_road(in[u], road, u);
}

/// The smallest value of a row; infinite where there is none.
float lowest_of_row(const float* row, int width) {
  constexpr int chains = 8;  // one a column in turn, so that compilers use vectors
  std::array<float, chains> lowest{};
  lowest.fill(std::numeric_limits<float>::infinity());
  int u = 0;
  for (; u + chains <= width; u += chains) {
    for (std::size_t k = 0; k < lowest.size(); ++k) lowest[k] = std::min(lowest[k], row[u + static_cast<int>(k)]);
  }
  for (; u < width; ++u) lowest[0] = std::min(lowest[0], row[u]);
  return *std::min_element(lowest.begin(), lowest.end());
}

}  // namespace

double transform_disparity(ImageView<const float> disparity, const RollEstimate& geometry, double min_delta_t,
                           const RollOptions& options, int threads, Image<float>& transformed) {
  options.validate();
  if (disparity.empty()) fail("the disparity map is empty; a transformation needs one of at least 1×1 pixels");
  const int height = disparity.height();
  transformed.resize(disparity.width(), height);
  auto lowest = scratch_vector<float>(static_cast<std::size_t>(height));
  parallel_rows(height, rows_per_band, threads, [&](int first, int last, int) {
    for (int v = first; v < last; ++v) {
      float* out = transformed.row(v);
      subtract_road(disparity, geometry.plane, v, out);
      lowest[static_cast<std::size_t>(v)] = lowest_of_row(out, disparity.width());
    }
  });
  double delta_t = options.delta_t_px;
  if (delta_t < 0) delta_t = derived_delta_t(*std::min_element(lowest.begin(), lowest.end()), min_delta_t);
  parallel_rows(height, rows_per_band, threads, [&](int first, int last, int) {
    for (int v = first; v < last; ++v) {
      float* out = transformed.row(v);
      for (int u = 0; u < disparity.width(); ++u) out[u] += static_cast<float>(delta_t);
    }
  });
  return delta_t;
}

RoadResiduals measure_residuals(ImageView<const float> transformed, double delta_t, int threads) {
  auto residuals = scratch_vector<double>();
  const int step = spread_step(static_cast<double>(transformed.pixels()));
  for (int v = step / 2; v < transformed.height(); v += step) {
    for (int u = step / 2; u < transformed.width(); u += step) {
      if (!std::isnan(transformed(u, v))) residuals.push_back(transformed(u, v) - delta_t);
    }
  }
  std::erase_if(residuals, [](double r) { return std::abs(r) > spread_nearest_px; });
  const double limit = spread_limit(upper_median_magnitude(residuals));

  auto rows = scratch_vector<RowSpread>(static_cast<std::size_t>(transformed.height()));
  parallel_rows(transformed.height(), rows_per_band, threads, [&](int first, int last, int) {
    for (int v = first; v < last; ++v) {
      rows[static_cast<std::size_t>(v)] = spread_of_row(transformed.row(v), transformed.width(), delta_t, limit);
    }
  });
  Spread all{}, road{};
  for (const RowSpread& row : rows) {
    all.add(row.all);
    road.add(row.road);
  }
  return {road.deviation(), all.deviation(), all.n > 0 ? road.n / all.n : 0};
}

}  // namespace roadstereo
