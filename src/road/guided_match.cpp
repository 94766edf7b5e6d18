#include "road/guided_match.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/parallel.hpp"
#include "road/strip_correlation.hpp"

namespace roadstereo {
namespace {

constexpr int half_width = 7;
constexpr int half_height = 3;
constexpr float least_deviation = 1.5f * grey_scale;
constexpr float least_correlation = 0.75f;
constexpr double steepest = 0.5;  ///< no road's disparity changes by that much per column

/// What one row of the grid found.
struct RowCount {
  int tried = 0;
  std::size_t found = 0;
};

/// The right image along the rows of a block, each column shifted by the plane. The plane is taken at the block's own
/// columns: over the range of the search it is the same to a small part of a pixel.
void sample_around(ImageView<const std::int16_t> right, const CorrelationBlock& block, int u, int v,
                   const RoadModel& plane, int range, Strip& strip) {
  const int first = u - half_width - range;
  for (int y = 0; y < block.height; ++y) {
    const int row = v + y - half_height;
    sample_strip(right.row(row), right.width(), first - plane.disparity(first, row), 1 - plane.a2,
                 block.width + 2 * range, strip.row(y));
  }
}

/// Residual of the highest correlation, refined by a parabola; nothing when it is low or at an end. Index 0 is +range,
/// so that indices grow with the right image's columns.
std::optional<double> best_residual(const StripCorrelations& correlations, int range) {
  const float* first = correlations.data();
  const float* last = first + std::ptrdiff_t{2} * range;
  const float* at = std::max_element(first, last + 1);
  if (*at < least_correlation || at == first || at == last) return std::nullopt;
  const double before = *(at - 1), after = *(at + 1);
  const double curvature = 2 * before + 2 * after - 4 * static_cast<double>(*at);
  const double offset = curvature < 0 ? (before - after) / curvature : 0;
  return range - (static_cast<double>(at - first) + offset);
}

}  // namespace

GuidedMatches match_near_plane(ImageView<const std::int16_t> left, ImageView<const std::int16_t> right,
                               const RoadModel& plane, int range_px, int places, int threads) {
  const int pitch = std::max(1, static_cast<int>(std::sqrt(static_cast<double>(left.pixels()) / places)));
  const double slant = std::abs(plane.a1) * half_height + std::abs(plane.a2) * (half_width + range_px);
  const double reach = half_width + slant + range_px + 1;
  if (std::abs(plane.a2) >= steepest) return {};
  const int grid_rows = std::max(0, (left.height() - 2 * half_height + pitch - 1) / pitch);
  const std::size_t row_places = static_cast<std::size_t>(std::max(0, left.width() / pitch + 1));
  auto points = scratch_vector<DisparityPoint>(static_cast<std::size_t>(grid_rows) * row_places);
  auto rows = scratch_vector<RowCount>(static_cast<std::size_t>(grid_rows));
  parallel_for(grid_rows, threads, [&](int grid_row, int) {
    RowCount& row = rows[static_cast<std::size_t>(grid_row)];
    DisparityPoint* of_row = points.data() + static_cast<std::size_t>(grid_row) * row_places;
    const int v = half_height + grid_row * pitch;
    Strip strip{};
    StripCorrelations correlations{};
    for (int u = half_width; u + half_width < left.width(); u += pitch) {
      const double d = plane.disparity(u, v);
      // Above the horizon there is no road; the whole search must stay inside the right image.
      if (d <= 0 || u - d - reach < 0 || u - d + reach >= left.width() - 1) continue;
      const CorrelationBlock block(left, u, v, half_width, half_height);
      if (block.deviation < least_deviation) continue;
      ++row.tried;
      sample_around(right, block, u, v, plane, range_px, strip);
      correlate_strip(block, strip, 2 * range_px + 1, least_deviation, correlations);
      if (const auto residual = best_residual(correlations, range_px)) {
        // What was matched is the target column at u − residual of the shifted image.
        of_row[row.found++] = {static_cast<double>(u), static_cast<double>(v),
                               plane.disparity(u - *residual, v) + *residual};
      }
    }
  });
  GuidedMatches matches;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const DisparityPoint* of_row = points.data() + r * row_places;
    matches.points.insert(matches.points.end(), of_row, of_row + rows[r].found);
    matches.tried += rows[r].tried;
  }
  return matches;
}

}  // namespace roadstereo
