// Floor: 8 bytes a pixel to read σ and disparity, 8 to write where cells are rejected: 2 to 4 MB for 640×360. The flood
// fill from the border is one block of threads, which costs latency: two accesses of shared caches a cell and sweep
// along the rows and the columns, two to five sweeps; none where every cell is confirmed, as on most roads seen from
// above.

#include <cmath>

#include "core/cuda/launch.hpp"
#include "road/off_road/cuda/off_road.hpp"

namespace roadstereo::cuda {
namespace {

constexpr int block_columns = 32, block_rows = 8;
constexpr int pixel_rows = block_rows * alignment_cell;
constexpr int connecting_threads = 256;

__device__ int thread_column() {
  return static_cast<int>(blockIdx.x * block_columns + threadIdx.x);
}
__device__ int thread_row() {
  return static_cast<int>(blockIdx.y * block_rows + threadIdx.y);
}

/// One thread a cell.
__global__ void sum_log_sigmas(ImageView<const float> sigma, ImageView<LogSigmas> cells, int* doubtful) {
  begin_kernel();
  const int i = thread_column(), j = thread_row();
  if (i == 0 && j == 0) *doubtful = 0;
  if (i >= cells.width() || j >= cells.height()) return;
  LogSigmas sums;
  for (int v = j * alignment_cell; v < min((j + 1) * alignment_cell, sigma.height()); ++v) {
    for (int u = i * alignment_cell; u < min((i + 1) * alignment_cell, sigma.width()); ++u) {
      sums.add({log_sigma(__ldg(&sigma(u, v))), 1});
    }
  }
  cells(i, j) = sums;
}

/// One thread a cell: the window around it, and the scene. The road in its rows takes double precision, once a block.
__global__ void assess_cells(CoarseScene scene, ImageView<const LogSigmas> cells, ImageView<const float> correlation,
                             ImageView<const float> disparity, float log2_max_sigma, ImageView<CellState> states,
                             int* doubtful) {
  begin_kernel();
  auto* lines = shared_memory<RowLine>();
  const int thread = static_cast<int>(threadIdx.y) * block_columns + static_cast<int>(threadIdx.x);
  if (thread < pixel_rows) lines[thread] = shift_line(scene.shift, static_cast<int>(blockIdx.y) * pixel_rows + thread);
  __syncthreads();
  const int i = thread_column(), j = thread_row();
  if (i >= cells.width() || j >= cells.height()) return;
  LogSigmas sums;
  for (int y = max(0, j - confirmation_radius); y <= min(cells.height() - 1, j + confirmation_radius); ++y) {
    for (int x = max(0, i - confirmation_radius); x <= min(cells.width() - 1, i + confirmation_radius); ++x) {
      sums.add(cells(x, y));
    }
  }
  const bool confirmed = is_confirmed(sums, __ldg(&correlation(i, j)), log2_max_sigma);
  const RowLine* const of_cell = lines + static_cast<int>(threadIdx.y) * alignment_cell;
  ResidualSum residuals;
  for (int u = i * alignment_cell; u < min((i + 1) * alignment_cell, disparity.width()); ++u) {
    ResidualSum of_column;
    for (int y = 0; y < min(alignment_cell, disparity.height() - j * alignment_cell); ++y) {
      of_column.add(disparity(u, j * alignment_cell + y), of_cell[y], u);
    }
    residuals.add(of_column);
  }
  const CellState state = assess_cell(scene, residuals.mean(), confirmed, i, j);
  states(i, j) = state;
  if (state >= unconfirmed) atomicOr(doubtful, 1);
}

/// Cells that the flood fill can reach.
__device__ bool is_open(CellState state) {
  return state != on_road && state < outside;
}
__device__ void mark(CellState& state) {
  state = static_cast<CellState>(state + outside);
}

/// States along a row or a column of cells.
struct Line {
  CellState* at;
  std::ptrdiff_t step;    ///< to the next cell of the line
  std::ptrdiff_t across;  ///< to the next line
  int cells;
  bool has_before, has_behind;  ///< whether there are lines on either side

  /// A cell, or one of the two beside it across the line, is outside.
  __device__ bool touches(int k) const {
    const CellState* const cell = at + k * step;
    return *cell >= outside || (has_before && cell[-across] >= outside) || (has_behind && cell[across] >= outside);
  }
};

/// Carries `outside` along a line, forward and back, from its cells and those beside it. Returns whether a cell has
/// changed.
__device__ bool sweep(const Line& line) {
  bool changed = false;
  const auto visit = [&](int k) {
    CellState& cell = line.at[k * line.step];
    if (!is_open(cell)) return;
    if (line.touches(k) || (k > 0 && line.touches(k - 1)) || (k + 1 < line.cells && line.touches(k + 1))) {
      mark(cell);
      changed = true;
    }
  };
  for (int k = 0; k < line.cells; ++k) visit(k);
  for (int k = line.cells - 1; k >= 0; --k) visit(k);
  return changed;
}

__device__ void mark_border(CellState& cell) {
  if (is_open(cell)) mark(cell);
}

/// One block of threads: flood fill from the upper, left and right border, by sweeps until nothing changes. Every
/// second row and column takes part at a time, so that no thread reads what another one writes.
__global__ void mark_outside(ImageView<CellState> states, const int* doubtful) {
  begin_kernel();
  if (*doubtful == 0) return;  // nothing can be rejected
  const int columns = states.width(), rows = states.height();
  const int thread = static_cast<int>(threadIdx.x);
  for (int i = thread; i < columns; i += connecting_threads) mark_border(states(i, 0));
  __syncthreads();
  for (int j = thread; j < rows; j += connecting_threads) {
    mark_border(states(0, j));
    if (columns > 1) mark_border(states(columns - 1, j));
  }
  __syncthreads();
  int* const has_changed = shared_memory<int>();  // in the last sweeps, of any thread
  for (bool goes_on = true; goes_on;) {
    if (thread == 0) *has_changed = 0;
    bool changed = false;
    for (int odd = 0; odd < 2; ++odd) {
      for (int j = 2 * thread + odd; j < rows; j += 2 * connecting_threads) {
        changed |= sweep({states.row(j), 1, states.stride(), columns, j > 0, j + 1 < rows});
      }
      __syncthreads();
    }
    for (int odd = 0; odd < 2; ++odd) {
      for (int i = 2 * thread + odd; i < columns; i += 2 * connecting_threads) {
        changed |= sweep({states.data() + i, states.stride(), 1, rows, i > 0, i + 1 < columns});
      }
      __syncthreads();
    }
    if (changed) atomicOr(has_changed, 1);
    __syncthreads();
    goes_on = *has_changed != 0;
    __syncthreads();
  }
}

/// One thread a cell: its pixels become invalid where it is rejected.
__global__ void reject_cells(ImageView<const CellState> states, const int* doubtful, ImageView<float> disparity,
                             ImageView<float> sigma) {
  begin_kernel();
  if (*doubtful == 0) return;
  const int i = thread_column(), j = thread_row();
  if (i >= states.width() || j >= states.height() || !is_rejected(states, i, j)) return;
  for (int v = j * alignment_cell; v < min((j + 1) * alignment_cell, disparity.height()); ++v) {
    for (int u = i * alignment_cell; u < min((i + 1) * alignment_cell, disparity.width()); ++u) {
      disparity(u, v) = nanf("");
      sigma(u, v) = nanf("");
    }
  }
}

}  // namespace

void OffRoad::run(const CoarseScene& scene, ImageView<const float> correlation, float max_sigma_px,
                  ImageView<float> disparity, ImageView<float> sigma, StreamView stream) {
  const int columns = correlation.width(), rows = correlation.height();
  const std::size_t cells = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  sigmas_.reserve(cells);
  states_.reserve(cells);
  const ImageView<LogSigmas> sigmas(sigmas_.data(), columns, rows);
  const ImageView<CellState> states(states_.data(), columns, rows);
  const dim3 grid(blocks_for(columns, block_columns), blocks_for(rows, block_rows));
  const dim3 block(block_columns, block_rows);
  launch("off_road_sigmas", sum_log_sigmas, {grid, block, 0}, stream, ImageView<const float>(sigma), sigmas,
         doubtful_.data());
  launch("off_road_assess", assess_cells, {grid, block, pixel_rows * sizeof(RowLine)}, stream, scene,
         ImageView<const LogSigmas>(sigmas), correlation, ImageView<const float>(disparity), std::log2(max_sigma_px),
         states, doubtful_.data());
  launch("off_road_outside", mark_outside, {dim3(1), dim3(connecting_threads), sizeof(int)}, stream, states,
         doubtful_.data());
  launch("off_road_reject", reject_cells, {grid, block, 0}, stream, ImageView<const CellState>(states),
         doubtful_.data(), disparity, sigma);
}

}  // namespace roadstereo::cuda
