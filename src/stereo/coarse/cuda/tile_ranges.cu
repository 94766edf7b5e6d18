// Floor: a coarse pixel is read twice, once for each view, and a little more at the tiles' borders. A thread counts
// runs of equal disparities down a column, so that few additions meet in one counter.

#include <climits>

#include "core/cuda/launch.hpp"
#include "core/cuda/unroll.hpp"
#include "stereo/coarse/cuda/tile_ranges.hpp"
#include "stereo/coarse/tile_range.hpp"

namespace roadstereo::cuda {
namespace {

constexpr int threads = 512;
constexpr int rows_a_run = 8;
constexpr int rows_at_once = 8;  // whose disparities are on their way together: memory takes long

/// What the threads of a block share about their tile.
struct Found {
  std::uint32_t seen;
  int lowest, highest;            ///< supported
  int lowest_seen, highest_seen;  ///< of those between
};

/// The tile of a block, and the view in which it lies.
struct Tile {
  int column, row;
  bool of_target;
};

/// The columns of a view that belong to a tile, as tiles_of() says; those outside the image belong to the outermost.
struct TileColumns {
  __device__ TileColumns(const CoarseTiles& tiles, int tile)
      : first(tile == 0 ? INT_MIN : tile * tiles.columns - tile_overlap),
        end(tile + 1 == tiles.across ? INT_MAX : (tile + 1) * tiles.columns + tile_overlap) {}
  __device__ bool hold(int column) const { return first <= column && column < end; }
  int first, end;
};

/// Counts the pixels of one column of the map, from `first` to `end`, that lie in the tile.
__device__ void count_run(const ImageView<const float>& coarse, const CoarseTiles& tiles, const Tile& tile, int factor,
                          int u, int first, int end, std::uint32_t* counts, int bins) {
  const float inverse_factor = 1.0F / static_cast<float>(factor);
  const TileColumns columns(tiles, tile.column);
  int of_run = 0;
  std::uint32_t length = 0;
  for (int v = first; v < end; v += rows_at_once) {
    float disparities[rows_at_once];
    ROADSTEREO_UNROLL
    for (int k = 0; k < rows_at_once; ++k) disparities[k] = __ldg(&coarse(u, v + k < end ? v + k : v));
    ROADSTEREO_UNROLL
    for (int k = 0; k < rows_at_once; ++k) {
      const float disparity = disparities[k];
      if (v + k >= end || disparity != disparity) continue;
      const int column = tile.of_target ? tile_target_column(u, disparity, inverse_factor) : u;
      if (!columns.hold(column)) continue;
      const int bin = disparity_bin(disparity, bins);
      if (bin != of_run && length > 0) {
        atomicAdd(&counts[of_run], length);
        length = 0;
      }
      of_run = bin;
      ++length;
    }
  }
  if (length > 0) atomicAdd(&counts[of_run], length);
}

/// First coarse column or row that can belong to a tile, or the end of those.
__device__ int begin_of(int tile, int size) {
  return tile == 0 ? 0 : tile * size - tile_overlap;
}
__device__ int end_of(int tile, int size, int tiles, int count) {
  const int end = (tile + 1) * size + tile_overlap;
  return tile + 1 == tiles || end > count ? count : end;
}

__device__ void count_tile(const ImageView<const float>& coarse, const CoarseTiles& tiles, const Tile& tile, int factor,
                           std::uint32_t* counts, int bins) {
  const int first_row = begin_of(tile.row, tiles.rows),
            end_row = end_of(tile.row, tiles.rows, tiles.down, coarse.height());
  const int first = begin_of(tile.column, tiles.columns);
  // What lies in a tile of the target lies up to the largest disparity further right in the reference.
  const int max_shift = tile.of_target ? (bins + factor - 1) / factor + 1 : 0;
  int end = end_of(tile.column, tiles.columns, tiles.across, coarse.width()) + max_shift;
  end = end < coarse.width() ? end : coarse.width();
  const int columns = end - first, runs = (end_row - first_row + rows_a_run - 1) / rows_a_run;
  for (int i = static_cast<int>(threadIdx.x); i < columns * runs; i += threads) {
    const int from = first_row + i / columns * rows_a_run;
    const int to = from + rows_a_run < end_row ? from + rows_a_run : end_row;
    count_run(coarse, tiles, tile, factor, first + i % columns, from, to, counts, bins);
  }
}

/// The range that the counts of a tile leave, as TileRanges::choose finds it, with all threads of the block.
__device__ SearchRange choose_range(const std::uint32_t* counts, int bins, int factor, int disparities, Found& found) {
  const int last = bins - 1;
  const std::uint32_t needed = needed_support(found.seen);
  for (int d = static_cast<int>(threadIdx.x); d < last; d += threads) {
    if (is_supported(counts, bins, d, factor, needed)) atomicMin(&found.lowest, d);
  }
  __syncthreads();
  const int lowest = found.lowest;
  for (int d = static_cast<int>(threadIdx.x); d <= last; d += threads) {
    const int from = d - factor + 1 > 0 ? d - factor + 1 : 0;
    if (d > lowest && is_supported(counts, bins, from, factor, needed)) atomicMax(&found.highest, d);
  }
  __syncthreads();
  const int highest = found.highest > lowest ? found.highest : lowest;
  for (int d = lowest + static_cast<int>(threadIdx.x); d <= highest; d += threads) {
    if (counts[d] == 0) continue;
    atomicMin(&found.lowest_seen, d);
    atomicMax(&found.highest_seen, d);
  }
  __syncthreads();
  const int first = found.lowest_seen < highest ? found.lowest_seen : highest;
  return range_around(first, found.highest_seen > first ? found.highest_seen : first, disparities);
}

__global__ void range_of_tile(ImageView<const float> coarse, int factor, int disparities, CoarseTiles tiles,
                              SearchRange* reference, SearchRange* target) {
  begin_kernel();
  const int bins = disparities + factor;
  auto& found = *shared_memory<Found>();
  auto* counts = reinterpret_cast<std::uint32_t*>(&found + 1);
  const Tile tile{static_cast<int>(blockIdx.x), static_cast<int>(blockIdx.y), blockIdx.z == 1};
  for (int d = static_cast<int>(threadIdx.x); d < bins; d += threads) counts[d] = 0;
  if (threadIdx.x == 0) found = {0, bins - 1, 0, bins, -1};
  __syncthreads();
  count_tile(coarse, tiles, tile, factor, counts, bins);
  __syncthreads();
  for (int d = static_cast<int>(threadIdx.x); d < bins; d += threads) {
    if (counts[d] > 0) atomicAdd(&found.seen, counts[d]);
  }
  __syncthreads();
  SearchRange range{0, static_cast<std::int16_t>(disparities)};
  if (found.seen >= min_tile_pixels(tiles.columns * tiles.rows)) {
    range = choose_range(counts, bins, factor, disparities, found);
  }
  if (threadIdx.x == 0) (tile.of_target ? target : reference)[tile.row * tiles.across + tile.column] = range;
}

}  // namespace

void find_tile_ranges(ImageView<const float> coarse, int factor, int disparities, const CoarseTiles& tiles,
                      SearchRange* reference, SearchRange* target, StreamView stream) {
  const std::size_t bytes = sizeof(Found) + static_cast<std::size_t>(disparities + factor) * sizeof(std::uint32_t);
  const dim3 grid(static_cast<unsigned>(tiles.across), static_cast<unsigned>(tiles.down), 2);
  launch("range_of_tile", range_of_tile, {grid, threads, bytes}, stream, coarse, factor, disparities, tiles, reference,
         target);
}

}  // namespace roadstereo::cuda
