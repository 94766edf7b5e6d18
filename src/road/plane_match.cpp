#include "road/plane_match.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include "core/parallel.hpp"
#include "road/plane_search.hpp"
#include "road/road_search.hpp"
#include "road/strip_correlation.hpp"

namespace roadstereo {
namespace {

/// What one row of the grid found.
struct RowCount {
  int tried = 0;
  std::size_t found = 0;
  std::size_t near = 0;  ///< samples that match within a pixel of the plane
};

/// What rows of a search found, in order. `points` and `correlations` hold each row's behind room for as many as it can
/// have.
PlaneMatches gather(const ScratchVector<RowCount>& rows, const ScratchVector<DisparityPoint>& points,
                    const ScratchVector<float>& correlations, int min_points) {
  PlaneMatches matches;
  matches.min_points = min_points;
  const std::size_t points_of_row = points.size() / std::max<std::size_t>(rows.size(), 1);
  const std::size_t correlations_of_row = correlations.size() / std::max<std::size_t>(rows.size(), 1);
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const DisparityPoint* found = points.data() + r * points_of_row;
    const float* near = correlations.data() + r * correlations_of_row;
    matches.points.insert(matches.points.end(), found, found + rows[r].found);
    matches.correlations.insert(matches.correlations.end(), near, near + rows[r].near);
    matches.tried += rows[r].tried;
  }
  return matches;
}

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

/// The highest correlation, where it lies within a pixel of the plane.
std::optional<float> correlation_on_plane(const StripCorrelations& correlations, int range) {
  constexpr float min_correlation = 0.3F;  // below it chance decides
  const float* first = correlations.data();
  const float* at = std::max_element(first, first + std::ptrdiff_t{2} * range + 1);
  if (std::abs(at - first - range) > 1 || *at < min_correlation) return std::nullopt;
  return *at;
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

/// Searches around a plane at single samples.
class PlaneSearch {
 public:
  PlaneSearch(ImageView<const std::int16_t> left, ImageView<const std::int16_t> right, const DisparityPlane& plane,
              int range_px, float min_deviation, const MaskedBlocks& masked)
      : left_(left),
        right_(right),
        plane_(plane),
        masked_(masked),
        range_(range_px),
        min_deviation_(min_deviation),
        extent_(plane_search_extent(plane.a1, plane.a2, range_px)) {}

  /// Correlations of the block at (u, v) with the residuals +range … −range; false where there is no texture, the
  /// search leaves the image, or the block is masked.
  bool correlate(int u, int v, Strip& strip, StripCorrelations& correlations) const {
    if (!search_in_view(u, plane_.disparity(u, v), extent_, left_.width())) return false;
    if (masked_.contains(u, v, plane_block_half_width, plane_block_half_height)) return false;
    const CorrelationBlock block(left_, u, v, plane_block_half_width, plane_block_half_height);
    if (block.deviation < min_deviation_) return false;
    sample_around(right_, block, u, v, plane_, range_, strip);
    correlate_strip(block, strip, 2 * range_ + 1, min_deviation_, correlations);
    return true;
  }

  /// What was matched is the target column at u − residual of the shifted image.
  DisparityPoint point(double u, double v, double residual) const {
    return {u, v, plane_.disparity(u - residual, v) + residual};
  }

 private:
  ImageView<const std::int16_t> left_, right_;
  DisparityPlane plane_;
  const MaskedBlocks& masked_;
  int range_;
  float min_deviation_;
  double extent_;
};

/// Residual at the peak of a cell's mean correlation; nothing when it does not stand out from the other residuals.
std::optional<double> cell_residual(const StripCorrelations& sums, int range) {
  constexpr double min_peak_sigmas = 2.5;
  const int count = 2 * range + 1;
  const auto* first = sums.data();
  const auto* at = std::max_element(first, first + count);
  if (at == first || at == first + count - 1) return std::nullopt;
  double sum = 0, squares = 0;
  int others = 0;
  for (const auto* value = first; value < first + count; ++value) {
    if (std::abs(value - at) <= 2) continue;
    sum += *value;
    squares += static_cast<double>(*value) * *value;
    ++others;
  }
  if (others < 2) return std::nullopt;
  const double mean = sum / others;
  const double sigma = std::sqrt(std::max(0.0, squares / others - mean * mean));
  if (*at - mean < min_peak_sigmas * sigma) return std::nullopt;
  return range - (static_cast<double>(at - first) + parabola_offset(*(at - 1), *at, *(at + 1)));
}

}  // namespace

PlaneMatches match_along_plane(ImageView<const std::int16_t> left, ImageView<const std::int16_t> right,
                               const DisparityPlane& plane, int range_px, int places, int threads,
                               const MaskedBlocks& masked) {
  const SampleGrid grid = sample_grid(left.width(), left.height(), range_px, places);
  if (std::abs(plane.a2) >= plane_match_max_slant) return {};
  const PlaneSearch search(left, right, plane, range_px, plane_match_min_deviation, masked);
  auto points = scratch_vector<DisparityPoint>(static_cast<std::size_t>(grid.places()));
  auto near = scratch_vector<float>(static_cast<std::size_t>(grid.places()));
  auto rows = scratch_vector<RowCount>(static_cast<std::size_t>(grid.rows));
  parallel_for(grid.rows, threads, [&](int grid_row, int) {
    RowCount& row = rows[static_cast<std::size_t>(grid_row)];
    DisparityPoint* of_row = points.data() + static_cast<std::ptrdiff_t>(grid_row) * grid.columns;
    const int v = grid.row(grid_row);
    Strip strip{};
    StripCorrelations correlations{};
    for (int column = 0; column < grid.columns; ++column) {
      const int u = grid.column(column);
      if (!search.correlate(u, v, strip, correlations)) continue;
      ++row.tried;
      if (const auto correlation = correlation_on_plane(correlations, range_px)) {
        near[static_cast<std::size_t>(grid_row * grid.columns) + row.near++] = *correlation;
      }
      if (const auto residual = best_residual(correlations, range_px)) {
        of_row[row.found++] = search.point(u, v, *residual);
      }
    }
  });
  return gather(rows, points, near, min_matches);
}

PlaneMatches match_cells_along_plane(ImageView<const std::int16_t> left, ImageView<const std::int16_t> right,
                                     const DisparityPlane& plane, int range_px, int places, int threads,
                                     const MaskedBlocks& masked) {
  constexpr int cell = 5;  // samples along each side
  // What a single block hides in noise the mean of a cell shows.
  constexpr float cell_min_deviation = plane_match_min_deviation / 2;
  const SampleGrid grid = sample_grid(left.width(), left.height(), range_px, places);
  if (std::abs(plane.a2) >= plane_match_max_slant) return {};
  const PlaneSearch search(left, right, plane, range_px, cell_min_deviation, masked);
  const int cell_rows = (grid.rows + cell - 1) / cell, cell_columns = (grid.columns + cell - 1) / cell;
  auto points =
      scratch_vector<DisparityPoint>(static_cast<std::size_t>(cell_rows) * static_cast<std::size_t>(cell_columns));
  auto near =
      scratch_vector<float>(static_cast<std::size_t>(cell_rows) * static_cast<std::size_t>(cell * grid.columns));
  auto rows = scratch_vector<RowCount>(static_cast<std::size_t>(cell_rows));
  parallel_for(cell_rows, threads, [&](int cell_row, int) {
    RowCount& row = rows[static_cast<std::size_t>(cell_row)];
    DisparityPoint* of_row = points.data() + static_cast<std::ptrdiff_t>(cell_row) * cell_columns;
    Strip strip{};
    StripCorrelations correlations{};
    for (int cell_column = 0; cell_column < cell_columns; ++cell_column) {
      StripCorrelations sums{};
      double sum_u = 0, sum_v = 0;
      int samples = 0;
      for (int i = 0; i < cell * cell; ++i) {
        const int grid_row = cell_row * cell + i / cell, grid_column = cell_column * cell + i % cell;
        if (grid_row >= grid.rows || grid_column >= grid.columns) continue;
        const int u = grid.column(grid_column), v = grid.row(grid_row);
        if (!search.correlate(u, v, strip, correlations)) continue;
        if (const auto correlation = correlation_on_plane(correlations, range_px)) {
          near[static_cast<std::size_t>(cell_row * cell * grid.columns) + row.near++] = *correlation;
        }
        for (std::size_t k = 0; k <= 2 * static_cast<std::size_t>(range_px); ++k) sums[k] += correlations[k];
        sum_u += u;
        sum_v += v;
        ++samples;
      }
      if (samples < cell * cell / 2) continue;
      ++row.tried;
      if (const auto residual = cell_residual(sums, range_px)) {
        of_row[row.found++] = search.point(sum_u / samples, sum_v / samples, *residual);
      }
    }
  });
  return gather(rows, points, near, min_matches / 3);
}

}  // namespace roadstereo
