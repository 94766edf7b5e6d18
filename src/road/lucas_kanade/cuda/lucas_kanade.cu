// Floor: 12 bytes a pixel and 80 bytes a cell of 16 pixels: 4 MB for 640×360. Some 100 operations a pixel to sample and
// sum, and 250 additions a cell for a window of 5×5 cells: 27 million operations.

#include <cstddef>

#include "core/cuda/launch.hpp"
#include "core/cuda/warp.hpp"
#include "road/lucas_kanade/cuda/lucas_kanade.hpp"
#include "road/row_shift.hpp"

namespace roadstereo::cuda {
namespace {

constexpr int block_columns = 32, block_rows = 8;
// Small blocks of cells, since there are few cells.
constexpr int summing_threads = 64, cells_of_block = summing_threads / alignment_cell;
constexpr int solved_columns = 32, solved_rows = 2, solving_threads = solved_columns * solved_rows;

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

/// The cells that the windows of a block of solve_windows cover.
struct Window {
  __device__ Window(const ImageView<const AlignmentSums<float>>& cells, int radius)
      : left(max(0, static_cast<int>(blockIdx.x) * solved_columns - radius)),
        top(max(0, static_cast<int>(blockIdx.y) * solved_rows - radius)),
        columns(min(cells.width(), (static_cast<int>(blockIdx.x) + 1) * solved_columns + radius) - left),
        rows(min(cells.height(), (static_cast<int>(blockIdx.y) + 1) * solved_rows + radius) - top) {}
  int left, top, columns, rows;
};

/// Adds up over the neighbouring lanes of a cell; all of them get the sums.
__device__ AlignmentSums<float> sums_of_cell(const AlignmentSums<float>& of_lane) {
  static_assert(sizeof(AlignmentSums<float>) == 10 * sizeof(float), "every sum is exchanged");
  AlignmentSums<float> sums = of_lane;
  for (int mask = 1; mask < alignment_cell; mask *= 2) {
    AlignmentSums<float> other;
    for (float AlignmentSums<float>::*sum :
         {&AlignmentSums<float>::n, &AlignmentSums<float>::t, &AlignmentSums<float>::g, &AlignmentSums<float>::r,
          &AlignmentSums<float>::tt, &AlignmentSums<float>::tg, &AlignmentSums<float>::tr, &AlignmentSums<float>::gg,
          &AlignmentSums<float>::gr, &AlignmentSums<float>::rr}) {
      other.*sum = __shfl_xor_sync(whole_warp, sums.*sum, mask);
    }
    sums.add(other);
  }
  return sums;
}

/// One thread a row of a cell. Double precision is slow on small GPUs: the road's line in a row is found once a block.
__global__ void sum_cells(Maps maps, ImageView<AlignmentSums<float>> cells) {
  begin_kernel();
  auto* lines = shared_memory<RowLine>();
  const TransformedPair& pair = maps.pair;
  const int thread = static_cast<int>(threadIdx.x), row = thread % alignment_cell;
  const int i = static_cast<int>(blockIdx.x) * cells_of_block + thread / alignment_cell;
  const int j = static_cast<int>(blockIdx.y), top = j * alignment_cell, v = top + row;
  if (thread < alignment_cell) lines[thread] = shift_line(pair.shift, top + thread);
  __syncthreads();
  const int width = maps.disparity.width();
  AlignmentSums<float> sums{};
  if (v < maps.disparity.height()) {
    const int first = pair.first_column != nullptr ? __ldg(pair.first_column + v) : 0;
    const RowLine road = lines[row];
    const PrefilteredRow reference{pair.reference.row(v)}, target{pair.target.row(v)};
    for (int u = i * alignment_cell; u < min((i + 1) * alignment_cell, width); ++u) {
      const float residual = without_shift(__ldg(&maps.disparity(u, v)), road, u);
      sums.add(alignment_sample(reference, target, first, width, u, residual));
    }
  }
  sums = sums_of_cell(sums);  // by whole warps
  if (row == 0 && i < cells.width()) cells(i, j) = sums;
}

/// One thread a cell: the window around it. The cells around the block lie in shared memory.
__global__ void solve_windows(ImageView<const AlignmentSums<float>> cells, int radius, AlignmentSettings settings,
                              ImageView<float> shifts, ImageView<float> correlation) {
  begin_kernel();
  const Window window(cells, radius);
  auto* around = shared_memory<AlignmentSums<float>>();
  for (int n = static_cast<int>(threadIdx.x); n < window.columns * window.rows; n += solving_threads) {
    around[n] = cells(window.left + n % window.columns, window.top + n / window.columns);
  }
  __syncthreads();
  const int i = static_cast<int>(blockIdx.x) * solved_columns + static_cast<int>(threadIdx.x) % solved_columns;
  const int j = static_cast<int>(blockIdx.y) * solved_rows + static_cast<int>(threadIdx.x) / solved_columns;
  if (i >= cells.width() || j >= cells.height()) return;
  AlignmentSums<float> sums{};
  for (int y = max(0, j - radius); y <= min(cells.height() - 1, j + radius); ++y) {
    for (int x = max(0, i - radius); x <= min(cells.width() - 1, i + radius); ++x) {
      sums.add(around[(y - window.top) * window.columns + x - window.left]);
    }
  }
  shifts(i, j) = alignment_shift(sums, settings);
  correlation(i, j) = alignment_correlation(sums);
}

/// One thread a pixel: the shift between the cells. `scale`: of a disparity over that of a residual disparity.
__global__ void add_shifts(ImageView<const float> shifts, float scale, ImageView<const float> disparity,
                           ImageView<float> aligned) {
  begin_kernel();
  const int u = static_cast<int>(blockIdx.x * block_columns + threadIdx.x);
  const int v = static_cast<int>(blockIdx.y * block_rows + threadIdx.y);
  if (u >= aligned.width() || v >= aligned.height()) return;
  const CellPlace row = cell_place(v, shifts.height()), column = cell_place(u, shifts.width());
  const auto between_rows = [&](int i) {
    const float above = shifts(i, row.first);
    return above + row.share * (shifts(i, row.second) - above);
  };
  const float first = between_rows(column.first);
  aligned(u, v) = disparity(u, v) + scale * (first + column.share * (between_rows(column.second) - first));
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
  const dim3 summing(blocks_for(columns, cells_of_block), static_cast<unsigned>(rows));
  launch("lucas_kanade_sums", sum_cells, {summing, summing_threads, alignment_cell * sizeof(RowLine)}, stream,
         Maps{pair, disparity}, sums);
  const dim3 solving(blocks_for(columns, solved_columns), blocks_for(rows, solved_rows));
  const auto around = static_cast<std::size_t>((solved_columns + 2 * radius) * (solved_rows + 2 * radius));
  launch("lucas_kanade_solve", solve_windows, {solving, solving_threads, around * sizeof(AlignmentSums<float>)}, stream,
         sums, radius, settings, shifts, correlation);
  const float scale = 1 - shift_line(pair.shift, 0).slope;
  const dim3 shifting(blocks_for(aligned.width(), block_columns), blocks_for(aligned.height(), block_rows));
  launch("lucas_kanade_shift", add_shifts, {shifting, dim3(block_columns, block_rows)}, stream, shifts, scale,
         disparity, aligned);
  return correlation;
}

}  // namespace roadstereo::cuda
