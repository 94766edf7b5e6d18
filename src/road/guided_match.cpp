#include "road/guided_match.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/parallel.hpp"

namespace roadstereo {
namespace {

constexpr int half_width = 7;
constexpr int half_height = 3;
constexpr int width = 2 * half_width + 1;
constexpr int height = 2 * half_height + 1;
constexpr float block_pixels = width * height;
constexpr float least_deviation = 1.5f * grey_scale;
constexpr float least_correlation = 0.75f;

/// The search never goes further than this from the supposed road, pixels.
constexpr int widest_range = 8;
constexpr std::size_t most_residuals = 2 * widest_range + 1;
using Residuals = std::array<float, most_residuals>;

/// What one row of the grid found.
struct RowCount {
  int tried = 0;
  std::size_t found = 0;
};

/// A block of the left image around one place, without its mean.
struct Block {
  int u, v;
  std::array<std::array<float, width>, height> values{};
  float deviation = 0;

  Block(ImageView<const std::int16_t> left, int centre_u, int centre_v) : u(centre_u), v(centre_v) {
    float sum = 0;
    for (int y = 0; y < height; ++y) {
      const std::int16_t* row = left.row(v + y - half_height) + u - half_width;
      for (int x = 0; x < width; ++x) sum += at(x, y) = row[x];
    }
    float squares = 0;
    for (auto& row : values) {
      for (float& value : row) {
        value -= sum / block_pixels;
        squares += value * value;
      }
    }
    deviation = std::sqrt(squares / block_pixels);
  }

  float& at(int x, int y) { return values[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)]; }
};

/// The part of a row of the right image that a block is compared with.
using Strip = std::array<float, width + most_residuals - 1>;

/// Correlations of a block with the right image at the residuals −range … range (index 0 is +range, so that indices
/// grow with the right image's columns).
class ResidualSearch {
 public:
  ResidualSearch(const Block& block, ImageView<const std::int16_t> right, const RoadModel& plane, int range)
      : range_(range), count_(static_cast<std::size_t>(2 * range + 1)) {
    Residuals sums{}, squares{}, products{};
    Strip strip{};
    for (int y = 0; y < height; ++y) {
      sample(block, right, plane, y, strip);
      for (std::size_t x = 0; x < width; ++x) {
        const float left = block.values[static_cast<std::size_t>(y)][x];
        const float* r = strip.data() + x;
        for (std::size_t i = 0; i < count_; ++i) {
          sums[i] += r[i];
          squares[i] += r[i] * r[i];
          products[i] += r[i] * left;
        }
      }
    }
    for (std::size_t i = 0; i < count_; ++i) {
      const float mean = sums[i] / block_pixels;
      const float variance = squares[i] / block_pixels - mean * mean;
      const bool textured = variance >= least_deviation * least_deviation;
      correlation_[i] = textured ? products[i] / block_pixels / (block.deviation * std::sqrt(variance)) : -1.0f;
    }
  }

  /// Residual of the highest correlation, refined by a parabola; nothing when it is low or at an end.
  std::optional<double> best() const {
    const float* end = correlation_.data() + count_;
    const float* at = std::max_element(correlation_.data(), end);
    if (*at < least_correlation || at == correlation_.data() || at + 1 == end) return std::nullopt;
    const double before = *(at - 1), after = *(at + 1);
    const double curvature = 2 * before + 2 * after - 4 * static_cast<double>(*at);
    const double offset = curvature < 0 ? (before - after) / curvature : 0;
    return range_ - (static_cast<double>(at - correlation_.data()) + offset);
  }

 private:
  /// The right image along one row of the block, each column shifted by the plane, minus mid-grey. The plane is taken
  /// at the block's own columns: over the range of the search it is the same to a small part of a pixel.
  void sample(const Block& block, ImageView<const std::int16_t> right, const RoadModel& plane, int y,
              Strip& strip) const {
    const int row = block.v + y - half_height;
    const std::int16_t* r = right.row(row);
    const int first = block.u - half_width - range_;
    for (std::size_t i = 0; i < width + count_ - 1; ++i) {
      const int column = first + static_cast<int>(i);
      const double x = column - plane.disparity(column, row);
      const int base = static_cast<int>(x);
      const auto f = static_cast<float>(x - base);
      const float value = static_cast<float>(r[base]) + f * static_cast<float>(r[base + 1] - r[base]);
      strip[i] = value - grey_max / 2.0f;
    }
  }

  int range_;
  std::size_t count_;
  Residuals correlation_{};
};

}  // namespace

GuidedMatches match_near_plane(ImageView<const std::int16_t> left, ImageView<const std::int16_t> right,
                               const RoadModel& plane, int range_px, int places, int threads) {
  const int pitch = std::max(1, static_cast<int>(std::sqrt(static_cast<double>(left.pixels()) / places)));
  const double slant = std::abs(plane.a1) * half_height + std::abs(plane.a2) * (half_width + range_px);
  const double reach = half_width + slant + range_px + 1;
  const int grid_rows = std::max(0, (left.height() - 2 * half_height + pitch - 1) / pitch);
  const std::size_t row_places = static_cast<std::size_t>(std::max(0, left.width() / pitch + 1));
  auto points = scratch_vector<DisparityPoint>(static_cast<std::size_t>(grid_rows) * row_places);
  auto rows = scratch_vector<RowCount>(static_cast<std::size_t>(grid_rows));
  parallel_for(grid_rows, threads, [&](int grid_row, int) {
    RowCount& row = rows[static_cast<std::size_t>(grid_row)];
    DisparityPoint* of_row = points.data() + static_cast<std::size_t>(grid_row) * row_places;
    const int v = half_height + grid_row * pitch;
    for (int u = half_width; u + half_width < left.width(); u += pitch) {
      const double d = plane.disparity(u, v);
      // Above the horizon there is no road; the whole search must stay inside the right image.
      if (d <= 0 || u - d - reach < 0 || u - d + reach >= left.width() - 1) continue;
      const Block block(left, u, v);
      if (block.deviation < least_deviation) continue;
      ++row.tried;
      if (const auto residual = ResidualSearch(block, right, plane, range_px).best()) {
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
