#include "road/plane_match.hpp"

#include <algorithm>
#include <array>
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

/// Rows of the right image, each column shifted by the plane: what a block at column u of the left image matches around
/// u. Blocks of one row of the grid share them.
class ShiftedRows {
 public:
  ShiftedRows(ImageView<const std::int16_t> right, const DisparityPlane& plane, float min_deviation, int workers)
      : right_(right),
        plane_(plane),
        min_deviation_(min_deviation),
        columns_(right.width() + plane_match_max_range),
        pitch_(columns_ + Strip::guard),
        values_(scratch_vector<float>(static_cast<std::size_t>(workers) * size())) {}

  /// The rows of the blocks around row v. Columns that the right image does not show keep what they had; no search that
  /// is in view reaches them.
  void sample(int v, int worker) {
    float* const rows = memory(worker);
    const double step = 1 - plane_.a2;
    for (int y = 0; y < plane_block_height; ++y) {
      const int row = v + y - plane_block_half_height;
      const double shift = plane_.disparity(0, row), columns = columns_;
      const int first = static_cast<int>(std::clamp(std::ceil(shift / step), 0.0, columns));
      const int last = static_cast<int>(std::clamp(std::ceil((right_.width() - 1 + shift) / step), 0.0, columns));
      for (int u = first; u < last; u += max_sampled) {
        sample_strip(right_.row(row), right_.width(), u * step - shift, step, std::min(max_sampled, last - u),
                     rows + y * pitch_ + u);
      }
    }
    find_inverse_deviations({rows, pitch_}, plane_block_width, plane_block_height, columns_ - plane_block_width + 1,
                            min_deviation_, rows + plane_block_height * pitch_);
  }

  /// Correlates a block with the parts that begin at the columns first … first + count − 1.
  void correlate(const CorrelationBlock& block, int first, int count, int worker, StripValues& correlations) const {
    const float* const rows = memory(worker) + first;
    correlate_strip(block, {rows, pitch_}, rows + plane_block_height * pitch_, count, correlations);
  }

 private:
  /// The rows of a block, and the inverse deviations of the parts that begin at each column.
  std::size_t size() const { return static_cast<std::size_t>((plane_block_height + 1) * pitch_); }
  float* memory(int worker) { return values_.data() + static_cast<std::size_t>(worker) * size(); }
  const float* memory(int worker) const { return values_.data() + static_cast<std::size_t>(worker) * size(); }

  ImageView<const std::int16_t> right_;
  DisparityPlane plane_;
  float min_deviation_;
  int columns_;
  std::ptrdiff_t pitch_;
  ScratchVector<float> values_;
};

/// Correlations of a block with the residuals +range … −range, so that indices grow with the right image's columns.
struct BlockCorrelations {
  StripValues values;
  int highest;  ///< index
};

/// The highest correlation, where it lies within a pixel of the plane.
std::optional<float> correlation_on_plane(const BlockCorrelations& correlations, int range) {
  const float highest = correlations.values[static_cast<std::size_t>(correlations.highest)];
  if (std::abs(correlations.highest - range) > 1 || highest < plane_match_min_telling_correlation) return std::nullopt;
  return highest;
}

/// Residual of a value that is neither the first nor the last, refined by a parabola.
double residual_at(const float* values, std::ptrdiff_t index, int range) {
  const float* at = values + index;
  return range - (static_cast<double>(index) + parabola_offset(*(at - 1), *at, *(at + 1)));
}

/// Residual of the highest correlation; nothing when it is low or at an end.
std::optional<double> best_residual(const BlockCorrelations& correlations, int range) {
  const int at = correlations.highest;
  if (correlations.values[static_cast<std::size_t>(at)] < plane_match_min_correlation || at == 0 || at == 2 * range) {
    return std::nullopt;
  }
  return residual_at(correlations.values.data(), at, range);
}

/// Searches around a plane at single samples.
class PlaneSearch {
 public:
  PlaneSearch(ImageView<const std::int16_t> left, ImageView<const std::int16_t> right, const DisparityPlane& plane,
              int range_px, float min_deviation, const MaskedBlocks& masked, int threads)
      : left_(left),
        plane_(plane),
        masked_(masked),
        range_(range_px),
        min_deviation_(min_deviation),
        extent_(plane_search_extent(plane.a1, plane.a2, range_px)),
        rows_(right, plane, min_deviation, resolve_threads(threads)) {}

  /// To be called before the blocks of a row are correlated; false above the horizon.
  bool begin_row(int v, int worker) {
    if (!(std::max(plane_.disparity(0, v), plane_.disparity(left_.width() - 1, v)) > 0)) return false;
    rows_.sample(v, worker);
    return true;
  }

  /// Correlations of the block at (u, v) of the row that was begun; false where there is no texture, the search leaves
  /// the image, or the block is masked.
  bool correlate(int u, int v, int worker, BlockCorrelations& correlations) const {
    if (!search_in_view(u, plane_.disparity(u, v), extent_, left_.width())) return false;
    if (masked_.contains(u, v, plane_block_half_width, plane_block_half_height)) return false;
    const CorrelationBlock block(left_, u, v, plane_block_half_width, plane_block_half_height);
    if (block.deviation < min_deviation_) return false;
    const int count = 2 * range_ + 1;
    rows_.correlate(block, u - plane_block_half_width - range_, count, worker, correlations.values);
    correlations.highest = index_of_highest(correlations.values, count);
    return true;
  }

  /// What was matched is the target column at u − residual of the shifted image.
  DisparityPoint point(double u, double v, double residual) const {
    return {u, v, plane_.disparity(u - residual, v) + residual};
  }

 private:
  ImageView<const std::int16_t> left_;
  DisparityPlane plane_;
  const MaskedBlocks& masked_;
  int range_;
  float min_deviation_;
  double extent_;
  ShiftedRows rows_;
};

constexpr int cell_samples = 5;  ///< of a cell, along each side

/// Sums over the samples of a cell.
struct Cell {
  std::array<float, 2 * plane_match_max_range + 1> correlations{};
  double u = 0, v = 0;
  int samples = 0;
};

/// Residual at the peak of a cell's mean correlation; nothing when it does not stand out from the other residuals.
std::optional<double> cell_residual(const Cell& cell, int range) {
  constexpr double min_peak_sigmas = 2.5;
  const int count = 2 * range + 1;
  const auto* first = cell.correlations.data();
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
  return residual_at(first, at - first, range);
}

}  // namespace

PlaneMatches match_along_plane(ImageView<const std::int16_t> left, ImageView<const std::int16_t> right,
                               const DisparityPlane& plane, int range_px, int places, int threads,
                               const MaskedBlocks& masked) {
  const SampleGrid grid = sample_grid(left.width(), left.height(), range_px, places);
  if (std::abs(plane.a2) >= plane_match_max_slant) return {};
  PlaneSearch search(left, right, plane, range_px, plane_match_min_deviation, masked, threads);
  auto points = scratch_vector<DisparityPoint>(static_cast<std::size_t>(grid.places()));
  auto near = scratch_vector<float>(static_cast<std::size_t>(grid.places()));
  auto rows = scratch_vector<RowCount>(static_cast<std::size_t>(grid.rows));
  parallel_for(grid.rows, threads, [&](int grid_row, int worker) {
    RowCount& row = rows[static_cast<std::size_t>(grid_row)];
    DisparityPoint* of_row = points.data() + static_cast<std::ptrdiff_t>(grid_row) * grid.columns;
    float* near_of_row = near.data() + static_cast<std::ptrdiff_t>(grid_row) * grid.columns;
    const int v = grid.row(grid_row);
    if (!search.begin_row(v, worker)) return;
    BlockCorrelations correlations{};
    for (int column = 0; column < grid.columns; ++column) {
      const int u = grid.column(column);
      if (!search.correlate(u, v, worker, correlations)) continue;
      ++row.tried;
      if (const auto correlation = correlation_on_plane(correlations, range_px)) near_of_row[row.near++] = *correlation;
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
  // What a single block hides in noise the mean of a cell shows.
  constexpr float cell_min_deviation = plane_match_min_deviation / 2;
  const SampleGrid grid = sample_grid(left.width(), left.height(), range_px, places);
  if (std::abs(plane.a2) >= plane_match_max_slant) return {};
  PlaneSearch search(left, right, plane, range_px, cell_min_deviation, masked, threads);
  const int cell_rows = (grid.rows + cell_samples - 1) / cell_samples;
  const int cell_columns = (grid.columns + cell_samples - 1) / cell_samples;
  const std::size_t cells = static_cast<std::size_t>(cell_rows) * static_cast<std::size_t>(cell_columns);
  auto cell_sums = scratch_vector<Cell>(cells);
  auto points = scratch_vector<DisparityPoint>(cells);
  auto near = scratch_vector<float>(static_cast<std::size_t>(cell_rows) *
                                    static_cast<std::size_t>(cell_samples * grid.columns));
  auto rows = scratch_vector<RowCount>(static_cast<std::size_t>(cell_rows));
  parallel_for(cell_rows, threads, [&](int cell_row, int worker) {
    RowCount& row = rows[static_cast<std::size_t>(cell_row)];
    Cell* const cells_of_row = cell_sums.data() + static_cast<std::ptrdiff_t>(cell_row) * cell_columns;
    DisparityPoint* of_row = points.data() + static_cast<std::ptrdiff_t>(cell_row) * cell_columns;
    float* near_of_row = near.data() + static_cast<std::ptrdiff_t>(cell_row) * cell_samples * grid.columns;
    const int first_row = cell_row * cell_samples;
    BlockCorrelations correlations{};
    for (int grid_row = first_row; grid_row < std::min(first_row + cell_samples, grid.rows); ++grid_row) {
      const int v = grid.row(grid_row);
      if (!search.begin_row(v, worker)) continue;
      for (int column = 0; column < grid.columns; ++column) {
        const int u = grid.column(column);
        if (!search.correlate(u, v, worker, correlations)) continue;
        if (const auto correlation = correlation_on_plane(correlations, range_px)) {
          near_of_row[row.near++] = *correlation;
        }
        Cell& cell = cells_of_row[column / cell_samples];
        for (std::size_t k = 0; k < cell.correlations.size(); ++k) cell.correlations[k] += correlations.values[k];
        cell.u += u;
        cell.v += v;
        ++cell.samples;
      }
    }
    for (const Cell* cell = cells_of_row; cell < cells_of_row + cell_columns; ++cell) {
      if (cell->samples < cell_samples * cell_samples / 2) continue;
      ++row.tried;
      if (const auto residual = cell_residual(*cell, range_px)) {
        of_row[row.found++] = search.point(cell->u / cell->samples, cell->v / cell->samples, *residual);
      }
    }
  });
  return gather(rows, points, near, min_matches / 3);
}

}  // namespace roadstereo
