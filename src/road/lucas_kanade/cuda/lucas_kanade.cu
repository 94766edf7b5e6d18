// Floor: 12 bytes a pixel and 80 bytes a cell of 16 pixels: 4 MB for 640×360. Some 100 operations a pixel to sample and
// sum, and 250 additions a cell for a window of 5×5 cells: 27 million operations.

#include <cstddef>

#include "core/cuda/launch.hpp"
#include "road/lucas_kanade/cuda/lucas_kanade.hpp"
#include "road/row_shift.hpp"

namespace roadstereo::cuda {
namespace {

constexpr int block_columns = 32, block_rows = 8;
constexpr int pixel_rows = block_rows * alignment_cell;  ///< of a block of cells

/// What is aligned.
struct Maps {
  TransformedPair pair;
  ImageView<const float> disparity;
};

/// A row that is prefiltered where it is read.
struct PrefilteredRow {
  const std::int16_t* row;

  __device__ float operator[](int u) const { return prefiltered(row, u); }
};

__device__ int thread_column() {
  return static_cast<int>(blockIdx.x * block_columns + threadIdx.x);
}
__device__ int thread_row() {
  return static_cast<int>(blockIdx.y * block_rows + threadIdx.y);
}

/// One thread a cell. Double precision is slow on small GPUs: the road's line in a row is found once a block.
__global__ void sum_cells(Maps maps, ImageView<AlignmentSums<float>> cells) {
  auto* lines = shared_memory<RowLine>();
  const TransformedPair& pair = maps.pair;
  const int thread = static_cast<int>(threadIdx.y) * block_columns + static_cast<int>(threadIdx.x);
  const int top = static_cast<int>(blockIdx.y) * pixel_rows;
  if (thread < pixel_rows) lines[thread] = shift_line(pair.shift, top + thread);
  __syncthreads();
  const int i = thread_column(), j = thread_row();
  if (i >= cells.width() || j >= cells.height()) return;
  const int width = maps.disparity.width();
  AlignmentSums<float> sums{};
  for (int v = j * alignment_cell; v < min((j + 1) * alignment_cell, maps.disparity.height()); ++v) {
    const int first = pair.first_column != nullptr ? __ldg(pair.first_column + v) : 0;
    const RowLine road = lines[v - top];
    const PrefilteredRow reference{pair.reference.row(v)}, target{pair.target.row(v)};
    for (int u = i * alignment_cell; u < min((i + 1) * alignment_cell, width); ++u) {
      const float residual = without_shift(__ldg(&maps.disparity(u, v)), road, u);
      sums.add(alignment_sample(reference, target, first, width, u, residual));
    }
  }
  cells(i, j) = sums;
}

/// One thread a cell: the window around it.
__global__ void solve_windows(ImageView<const AlignmentSums<float>> cells, int radius, AlignmentSettings settings,
                              ImageView<float> shifts, ImageView<float> correlation) {
  const int i = thread_column(), j = thread_row();
  if (i >= cells.width() || j >= cells.height()) return;
  AlignmentSums<float> sums{};
  for (int y = max(0, j - radius); y <= min(cells.height() - 1, j + radius); ++y) {
    for (int x = max(0, i - radius); x <= min(cells.width() - 1, i + radius); ++x) sums.add(cells(x, y));
  }
  shifts(i, j) = alignment_shift(sums, settings);
  correlation(i, j) = alignment_correlation(sums);
}

/// One thread a pixel: the shift between the cells. `scale`: of a disparity over that of a residual disparity.
__global__ void add_shifts(ImageView<const float> shifts, float scale, ImageView<const float> disparity,
                           ImageView<float> aligned) {
  const int u = thread_column(), v = thread_row();
  if (u >= aligned.width() || v >= aligned.height()) return;
  const CellPlace row = cell_place(v, shifts.height()), column = cell_place(u, shifts.width());
  const auto between_rows = [&](int i) {
    const float above = shifts(i, row.first);
    return above + row.share * (shifts(i, row.second) - above);
  };
  const float first = between_rows(column.first);
  aligned(u, v) = disparity(u, v) + scale * (first + column.share * (between_rows(column.second) - first));
}

dim3 grid_of(int width, int height) {
  return dim3(blocks_for(width, block_columns), blocks_for(height, block_rows));
}

}  // namespace

ImageView<const float> LucasKanade::run(const TransformedPair& pair, ImageView<const float> disparity, int radius,
                                        const AlignmentSettings& settings, ImageView<float> aligned,
                                        StreamView stream) {
  const int columns = alignment_cells(disparity.width()), rows = alignment_cells(disparity.height());
  const std::size_t cells = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  sums_.reserve(cells);
  shifts_.reserve(cells);
  correlation_.reserve(cells);
  const ImageView<AlignmentSums<float>> sums(sums_.data(), columns, rows);
  const ImageView<float> shifts(shifts_.data(), columns, rows), correlation(correlation_.data(), columns, rows);
  const dim3 block(block_columns, block_rows);
  launch("lucas_kanade_sums", sum_cells, {grid_of(columns, rows), block, pixel_rows * sizeof(RowLine)}, stream,
         Maps{pair, disparity}, sums);
  launch("lucas_kanade_solve", solve_windows, {grid_of(columns, rows), block, 0}, stream, sums, radius, settings,
         shifts, correlation);
  const float scale = 1 - shift_line(pair.shift, 0).slope;
  launch("lucas_kanade_shift", add_shifts, {grid_of(aligned.width(), aligned.height()), block, 0}, stream, shifts,
         scale, disparity, aligned);
  return correlation;
}

}  // namespace roadstereo::cuda
