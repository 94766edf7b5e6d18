#include "damage/surface_correlation.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <span>
#include <vector>

#include "core/parallel.hpp"
#include "damage/smoothing_error.hpp"
#include "road/cubic.hpp"

namespace roadstereo {
namespace {

constexpr int block_radius = 2;
constexpr std::size_t block_side = 2 * block_radius + 1;
constexpr std::size_t block_pixels = block_side * block_side;

/// Blocks that are compared together, one value of each: loops over them are vectorised.
constexpr std::size_t max_lanes = 32;
template <class Value>
using Lanes = std::array<Value, max_lanes>;
using Blocks = std::array<Lanes<float>, block_pixels>;

constexpr float unknown = std::numeric_limits<float>::quiet_NaN();

/// ZNCC, 0 if negative; NaN if a value is NaN or a block has no contrast.
void correlate(const Blocks& one, const Blocks& other, std::size_t lanes, Lanes<float>& result) {
  Lanes<float> a{}, b{}, aa{}, bb{}, ab{};
  for (std::size_t k = 0; k < block_pixels; ++k) {
    for (std::size_t l = 0; l < lanes; ++l) {
      const float x = one[k][l] - one[block_pixels / 2][l],
                  y = other[k][l] - other[block_pixels / 2][l];  // keeps digits
      a[l] += x;
      b[l] += y;
      aa[l] += x * x;
      bb[l] += y * y;
      ab[l] += x * y;
    }
  }
  constexpr float n = block_pixels;
  for (std::size_t l = 0; l < lanes; ++l) {
    const float variances = (aa[l] - a[l] * a[l] / n) * (bb[l] - b[l] * b[l] / n);
    const float zncc = std::max(0.0F, (ab[l] - a[l] * b[l] / n) / std::sqrt(variances));
    result[l] = variances > 0 ? zncc : unknown;
  }
}

/// Two neighbouring pixels of a row, loaded at once.
using PixelPair = std::int32_t;

float left_of(PixelPair pair) {
  return static_cast<float>(std::endian::native == std::endian::little ? pair << 16 >> 16 : pair >> 16);
}
float right_of(PixelPair pair) {
  return static_cast<float>(std::endian::native == std::endian::little ? pair >> 16 : pair << 16 >> 16);
}

/// Places in one axis: the pixel before each and the weights of the four pixels from the one before that on.
struct Places {
  Lanes<int> first;
  Lanes<float> before, at, after, beyond;

  void set(std::size_t lane, int pixel, float offset) {
    const CubicWeights weight = cubic_weights(offset);
    first[lane] = pixel;
    before[lane] = weight.before;
    at[lane] = weight.at;
    after[lane] = weight.after;
    beyond[lane] = weight.beyond;
  }
  CubicWeights weight(std::size_t lane) const { return {before[lane], at[lane], after[lane], beyond[lane]}; }
};

/// A row of the right image, but for its misalignment.
class RightRow {
 public:
  RightRow(const DamageInput& input, int v)
      : image_(input.right), misalignment_(input.misalignment), v_(v), is_aligned_(misalignment_.is_zero()) {}

  /// Columns x; NaN outside.
  void read(const Lanes<float>& x, std::size_t lanes, Lanes<float>& values) const {
    const auto end = static_cast<float>(image_.width() - 2);
    const double turned = misalignment_.columns_at(v_);
    Places columns;
    Lanes<float> inside_x, outside;
    for (std::size_t l = 0; l < lanes; ++l) {
      const auto column = static_cast<float>(double{x[l]} + turned);
      const bool inside = column >= 1 && column < end;
      const float safe = inside ? column : 1.0F;
      const int whole = static_cast<int>(safe);
      columns.set(l, whole, safe - static_cast<float>(whole));
      inside_x[l] = inside ? x[l] : 1.0F;
      outside[l] = inside ? 0.0F : unknown;
    }
    is_aligned_ ? read_aligned(columns, lanes, values) : read_between(columns, inside_x, lanes, outside, values);
    for (std::size_t l = 0; l < lanes; ++l) values[l] += outside[l];
  }

 private:
  /// Pixels of a row around places, as pairs: before and at, after and beyond.
  struct RowPixels {
    Lanes<PixelPair> left, right;

    void load(std::size_t lane, const std::int16_t* pixel) {
      std::memcpy(&left[lane], pixel - 1, sizeof(PixelPair));
      std::memcpy(&right[lane], pixel + 1, sizeof(PixelPair));
    }
    float at(const Places& columns, std::size_t lane) const {
      return weighted(columns.weight(lane), left_of(left[lane]), right_of(left[lane]), left_of(right[lane]),
                      right_of(right[lane]));
    }
  };

  void read_aligned(const Places& columns, std::size_t lanes, Lanes<float>& values) const {
    if (v_ < 1 || v_ + 2 >= image_.height()) {
      std::fill_n(values.begin(), lanes, unknown);
      return;
    }
    RowPixels pixels;
    for (std::size_t l = 0; l < lanes; ++l) pixels.load(l, image_.row(v_) + columns.first[l]);
    for (std::size_t l = 0; l < lanes; ++l) values[l] = pixels.at(columns, l);
  }

  /// Between the rows where the misalignment has moved the columns x.
  void read_between(const Places& columns, const Lanes<float>& x, std::size_t lanes, Lanes<float>& outside,
                    Lanes<float>& values) const {
    const int last_row = image_.height() - 3;
    Places rows;
    for (std::size_t l = 0; l < lanes; ++l) {
      const double row = v_ + misalignment_.rows_at(double{x[l]}, v_);
      const int truncated = static_cast<int>(row);
      const int whole = row < truncated ? truncated - 1 : truncated;
      const bool inside = whole >= 1 && whole <= last_row;
      rows.set(l, inside ? whole : 1, static_cast<float>(row - whole));
      outside[l] = inside ? outside[l] : unknown;
    }
    RowPixels before, at, after, beyond;
    for (std::size_t l = 0; l < lanes; ++l) {
      const std::int16_t* const pixel = image_.row(rows.first[l]) + columns.first[l];
      before.load(l, pixel - image_.stride());
      at.load(l, pixel);
      after.load(l, pixel + image_.stride());
      beyond.load(l, pixel + 2 * image_.stride());
    }
    for (std::size_t l = 0; l < lanes; ++l) {
      values[l] = weighted(rows.weight(l), before.at(columns, l), at.at(columns, l), after.at(columns, l),
                           beyond.at(columns, l));
    }
  }

  ImageView<const std::int16_t> image_;
  const Misalignment& misalignment_;
  int v_;
  bool is_aligned_;
};

/// Compares two surfaces by blocks of both images.
class SurfaceComparison {
 public:
  explicit SurfaceComparison(const DamageInput& input) : input_(input) {}

  static bool is_possible(const DamageInput& input) {
    return !input.right.empty() && !input.grey.empty() && !input.disparity.empty();
  }

  /// Votes of the blocks around the pixels `u` of row v: log of the likelihood ratio of the measured surface to the
  /// road at `surface`, from their correlations, truncated and scaled to [−1, 1]; 0 if either is unknown.
  void vote(int v, std::span<const int> u, std::span<const float> surface, std::span<float> votes) const {
    std::fill(votes.begin(), votes.end(), 0.0F);
    if (v < block_radius || v + block_radius >= input_.grey.height()) return;
    if (input_.grey.width() <= 2 * block_radius) return;
    for (std::size_t first = 0; first < u.size(); first += max_lanes) vote_lanes(v, u, surface, first, votes);
  }

 private:
  /// Votes of the blocks from `first` on, up to as many as are compared together.
  void vote_lanes(int v, std::span<const int> u, std::span<const float> surface, std::size_t first,
                  std::span<float> votes) const {
    constexpr float max_log_ratio = 2;  // an object that one camera alone sees counts no more than a block of the road
    const int width = input_.grey.width();
    const std::size_t lanes = std::min(u.size() - first, max_lanes);
    Lanes<int> column;
    Lanes<float> road_surface;
    for (std::size_t l = 0; l < lanes; ++l) {
      column[l] = std::clamp(u[first + l], block_radius, width - 1 - block_radius);
      road_surface[l] = surface[first + l];
    }
    Blocks left, measured, road;
    std::size_t k = 0;
    for (int y = v - block_radius; y <= v + block_radius; ++y) {
      const RightRow row(input_, y);
      const std::int16_t* const grey = input_.grey.row(y);
      const float *const disparity = input_.disparity.row(y), *const transformed = input_.transformed.row(y);
      for (int x = -block_radius; x <= block_radius; ++x, ++k) {
        Lanes<float> disparities, transforms, at, at_road;
        for (std::size_t l = 0; l < lanes; ++l) {
          const int pixel = column[l] + x;
          left[k][l] = grey[pixel];
          disparities[l] = disparity[pixel];
          transforms[l] = transformed[pixel];
        }
        for (std::size_t l = 0; l < lanes; ++l) {
          at[l] = static_cast<float>(column[l] + x) - disparities[l];
          at_road[l] = at[l] - (road_surface[l] - transforms[l]);
        }
        row.read(at, lanes, measured[k]);
        row.read(at_road, lanes, road[k]);
      }
    }
    Lanes<float> along_measured, along_road;
    correlate(left, measured, lanes, along_measured);
    correlate(left, road, lanes, along_road);
    for (std::size_t l = 0; l < lanes; ++l) {
      if (u[first + l] != column[l]) continue;  // the block is not inside the image
      const float log_ratio = log_likelihood(along_measured[l]) - log_likelihood(along_road[l]);
      votes[first + l] = std::isnan(log_ratio) ? 0 : std::clamp(log_ratio / max_log_ratio, -1.0F, 1.0F);
    }
  }

  /// Log likelihood of a block along a surface, but for a constant: grey levels differ by normal noise.
  static float log_likelihood(float correlation) {
    constexpr float min_noise_share = 1e-4F;
    return -0.5F * float{block_pixels} * std::log(std::max(1 - correlation * correlation, min_noise_share));
  }

  const DamageInput& input_;
};

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
  void vote(const SurfaceComparison& comparison, int v) {
    votes.resize(u.size());
    comparison.vote(v, u, surface, votes);
  }
};

/// Sums of votes, and of the blocks that have one.
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
    const SurfaceComparison comparison(input);
    parallel_rows(blocks_before(rows_), rows_per_band, threads, [&](int first, int last, int) {
      RowOfBlocks row;
      for (int j = first; j < last; ++j) add_row(comparison, cells, surface, max_distance, j, row);
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
  void add_row(const SurfaceComparison& comparison, const Cells& cells, const RoadSurface& surface, float max_distance,
               int j, RowOfBlocks& row) {
    const float *const road = surface.value.row(j * step), *const measured = cells.value.row(j * step);
    VoteSums* const sums = sums_.row(j + 1) + 1;
    row.clear();
    for (int i = 0; i < columns_; i += step) {
      const bool is_off = std::abs(road[i] - measured[i]) > max_distance;
      sums[i / step].blocks = is_off ? 1 : 0;
      if (is_off) row.add(cells.centre(i, j * step)[0], road[i]);
    }
    row.vote(comparison, cells.centre(0, j * step)[1]);
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
  if (!SurfaceComparison::is_possible(input)) return unknown;
  constexpr double max_blocks = 2000;
  const int step =
      std::max(block_radius, static_cast<int>(std::ceil(std::sqrt(box.width() * box.height() / max_blocks))));
  const SurfaceComparison comparison(input);
  double votes = 0, blocks = 0;
  RowOfBlocks row;
  for (int v = box.v0; v <= box.v1; v += step) {
    row.clear();
    for (int u = box.u0; u <= box.u1; u += step) {
      if (maps.ids(u, v) == id) row.add(u, maps.surface(u, v) + static_cast<float>(offset));
    }
    row.vote(comparison, v);
    for (const float vote : row.votes) votes += vote;
    blocks += static_cast<double>(row.votes.size());
  }
  const double independent = blocks * std::min(1.0, static_cast<double>(step * step) / block_pixels);
  return blocks > 0 ? votes / blocks * std::sqrt(std::max(1.0, independent)) : double{unknown};
}

bool move_unsupported_cells(const DamageInput& input, const RoadSurface& surface, int threads, Cells& cells) {
  constexpr int rows_per_band = 16, window_radius_px = SmoothingError::window_radius_px;
  constexpr float max_sigmas = 3;
  if (!SurfaceComparison::is_possible(input)) return false;
  const float max_distance = max_sigmas * static_cast<float>(surface.noise);
  const VoteIntegral integral(input, cells, surface, max_distance, threads);
  const int radius = (window_radius_px + cells.factor - 1) / cells.factor;
  std::atomic<bool> moved = false;
  parallel_rows(cells.height(), rows_per_band, threads, [&](int first, int last, int) {
    bool moved_here = false;
    for (int j = first; j < last; ++j) {
      const float* const road = surface.value.row(j);
      float* const measured = cells.value.row(j);
      for (int i = 0; i < cells.width(); ++i) {
        if (!(std::abs(road[i] - measured[i]) > max_distance)) continue;
        const VoteSums sums = integral.around(i, j, radius);
        if (sums.votes >= -std::sqrt(sums.blocks)) continue;
        measured[i] = road[i];
        moved_here = true;
      }
    }
    if (moved_here) moved = true;
  });
  return moved;
}

}  // namespace roadstereo
