#include "road/plane_match.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/parallel.hpp"
#include "road/plane_search.hpp"
#include "road/strip_correlation.hpp"

namespace roadstereo {
namespace {

/// What one row of the grid found.
struct RowCount {
  int tried = 0;
  std::size_t found = 0;
};

/// The right image along the rows of a block, each column shifted by the plane. The plane is taken at the block's own
/// columns: over the range of the search it is the same to a small part of a pixel.
void sample_around(ImageView<const std::int16_t> right, const CorrelationBlock& block, int u, int v,
                   const DisparityPlane& plane, int range, Strip& strip) {
  const int first = u - plane_block_half_width - range;
  for (int y = 0; y < block.height; ++y) {
    const int row = v + y - plane_block_half_height;
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
  if (*at < plane_match_min_correlation || at == first || at == last) return std::nullopt;
  return range - (static_cast<double>(at - first) + parabola_offset(*(at - 1), *at, *(at + 1)));
}

}  // namespace

PlaneMatches match_along_plane(ImageView<const std::int16_t> left, ImageView<const std::int16_t> right,
                               const DisparityPlane& plane, int range_px, int places, int threads) {
  const SampleGrid grid = sample_grid(left.width(), left.height(), range_px, places);
  const double reach = plane_search_extent(plane.a1, plane.a2, range_px);
  if (std::abs(plane.a2) >= plane_match_max_slant) return {};
  auto points = scratch_vector<DisparityPoint>(static_cast<std::size_t>(grid.places()));
  auto rows = scratch_vector<RowCount>(static_cast<std::size_t>(grid.rows));
  parallel_for(grid.rows, threads, [&](int grid_row, int) {
    RowCount& row = rows[static_cast<std::size_t>(grid_row)];
    DisparityPoint* of_row = points.data() + static_cast<std::ptrdiff_t>(grid_row) * grid.columns;
    const int v = grid.row(grid_row);
    Strip strip{};
    StripCorrelations correlations{};
    for (int column = 0; column < grid.columns; ++column) {
      const int u = grid.column(column);
      if (!search_in_view(u, plane.disparity(u, v), reach, left.width())) continue;
      const CorrelationBlock block(left, u, v, plane_block_half_width, plane_block_half_height);
      if (block.deviation < plane_match_min_deviation) continue;
      ++row.tried;
      sample_around(right, block, u, v, plane, range_px, strip);
      correlate_strip(block, strip, 2 * range_px + 1, plane_match_min_deviation, correlations);
      if (const auto residual = best_residual(correlations, range_px)) {
        // What was matched is the target column at u − residual of the shifted image.
        of_row[row.found++] = {static_cast<double>(u), static_cast<double>(v),
                               plane.disparity(u - *residual, v) + *residual};
      }
    }
  });
  PlaneMatches matches;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const DisparityPoint* of_row = points.data() + r * static_cast<std::size_t>(grid.columns);
    matches.points.insert(matches.points.end(), of_row, of_row + rows[r].found);
    matches.tried += rows[r].tried;
  }
  return matches;
}

}  // namespace roadstereo
