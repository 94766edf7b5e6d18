#include "damage/surface_correlation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/parallel.hpp"
#include "damage/block_votes.hpp"
#include "damage/sampling_step.hpp"
#include "damage/smoothing_error.hpp"

namespace roadstereo {
namespace {

/// Blocks of one row to compare, and their votes.
struct RowOfBlocks {
  std::vector<int> u;
  std::vector<float> surface, votes;

  void clear() {
    u.clear();
    surface.clear();
  }
  void add(int column, float at) {
    u.push_back(column);
    surface.push_back(at);
  }
  void vote(const DamageInput& input, int v) {
    votes.resize(u.size());
    vote_for_blocks(input, v, u, surface, votes);
  }
};

/// Sums of votes, and of the blocks that are asked; one without contrast or disparities votes for neither.
struct VoteSums {
  double votes = 0, blocks = 0;

  VoteSums& operator+=(const VoteSums& other) {
    votes += other.votes;
    blocks += other.blocks;
    return *this;
  }
};

/// Votes of the cells off the surface, one in `step` columns and rows, as an integral image.
class VoteIntegral {
 public:
  static constexpr int step = 2;  // cells from block to block

  VoteIntegral(const DamageInput& input, const Cells& cells, const RoadSurface& surface, float max_distance,
               int threads)
      : columns_(cells.width()), rows_(cells.height()), sums_(blocks_before(columns_) + 1, blocks_before(rows_) + 1) {
    constexpr int rows_per_band = 8;
    parallel_rows(blocks_before(rows_), rows_per_band, threads, [&](int first, int last, int) {
      RowOfBlocks row;
      for (int j = first; j < last; ++j) add_row(input, cells, surface, max_distance, j, row);
    });
    for (int j = 2; j < sums_.height(); ++j) {
      for (int i = 0; i < sums_.width(); ++i) sums_(i, j) += sums_(i, j - 1);
    }
  }

  /// Sums over the (2·radius + 1)² cells around a cell.
  VoteSums around(int i, int j, int radius) const {
    const int top = blocks_before(std::max(0, j - radius)), bottom = blocks_before(std::min(rows_, j + radius + 1));
    const int first = blocks_before(std::max(0, i - radius)), last = blocks_before(std::min(columns_, i + radius + 1));
    const VoteSums &a = sums_(last, bottom), &b = sums_(first, bottom), &c = sums_(last, top), &d = sums_(first, top);
    return {a.votes - b.votes - c.votes + d.votes, a.blocks - b.blocks - c.blocks + d.blocks};
  }

 private:
  static int blocks_before(int cell) { return (cell + step - 1) / step; }

  /// Sums of block row j from the left.
  void add_row(const DamageInput& input, const Cells& cells, const RoadSurface& surface, float max_distance, int j,
               RowOfBlocks& row) {
    const float *const road = surface.value.row(j * step), *const measured = cells.value.row(j * step);
    VoteSums* const sums = sums_.row(j + 1) + 1;
    row.clear();
    for (int i = 0; i < columns_; i += step) {
      const bool is_off = std::abs(road[i] - measured[i]) > max_distance;
      sums[i / step].blocks = is_off ? 1 : 0;
      if (is_off) row.add(cells.centre(i, j * step)[0], road[i]);
    }
    row.vote(input, cells.centre(0, j * step)[1]);
    VoteSums sum;
    std::size_t next = 0;
    for (int k = 0; k < blocks_before(columns_); ++k) {
      if (sums[k].blocks > 0) sums[k].votes = double{row.votes[next++]};
      sums[k] = sum += sums[k];
    }
  }

  int columns_, rows_;  ///< cells
  Image<VoteSums> sums_;
};

}  // namespace

double surface_significance(const DamageInput& input, const DamageMap& maps, int id, const PixelBox& box,
                            double offset) {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  if (!has_blocks(input)) return unknown;
  constexpr double max_blocks = 2000;
  const int step = sampling_step(box, max_blocks, block_radius);
  double votes = 0, blocks = 0;
  RowOfBlocks row;
  for (int v = box.v0; v <= box.v1; v += step) {
    row.clear();
    for (int u = box.u0; u <= box.u1; u += step) {
      if (maps.ids(u, v) == id) row.add(u, maps.surface(u, v) + static_cast<float>(offset));
    }
    row.vote(input, v);
    for (const float vote : row.votes) votes += vote;
    blocks += static_cast<double>(row.votes.size());
  }
  const double independent =
      blocks * std::min(1.0, static_cast<double>(step * step) / static_cast<double>(block_pixels));
  return blocks > 0 ? votes / blocks * std::sqrt(std::max(1.0, independent)) : unknown;
}

void move_unsupported_cells(const DamageInput& input, const RoadSurface& surface, int threads, Cells& cells) {
  constexpr int rows_per_band = 16, window_radius_px = SmoothingError::window_radius_px;
  constexpr float max_sigmas = 3;
  if (!has_blocks(input)) return;
  const float max_distance = max_sigmas * static_cast<float>(surface.noise);
  const VoteIntegral integral(input, cells, surface, max_distance, threads);
  const int radius = (window_radius_px + cells.factor - 1) / cells.factor;
  parallel_rows(cells.height(), rows_per_band, threads, [&](int first, int last, int) {
    for (int j = first; j < last; ++j) {
      const float* const road = surface.value.row(j);
      float* const measured = cells.value.row(j);
      for (int i = 0; i < cells.width(); ++i) {
        if (!(std::abs(road[i] - measured[i]) > max_distance)) continue;
        const VoteSums sums = integral.around(i, j, radius);
        if (sums.votes < -std::sqrt(sums.blocks)) measured[i] = road[i];
      }
    }
  });
}

}  // namespace roadstereo
