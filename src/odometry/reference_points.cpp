#include "odometry/reference_points.hpp"

#include <algorithm>
#include <cmath>

namespace roadstereo {
namespace {

constexpr int max_points = 5000;         // of level 0
constexpr int max_coarse_points = 1500;  // of the other levels
constexpr int max_patches = 400;
constexpr int error_cell = 32;  // pixels: wider than the windows of matching and refinement

/// Side of square cells of which `count` cover the image.
int cell_side(int width, int height, int count) {
  return std::max(1, static_cast<int>(std::ceil(std::sqrt(static_cast<double>(width) * height / count))));
}

/// Slopes of the disparity from pixels at a distance, when all of them lie on one surface.
void find_slopes(const LinkMaps& frame, int u, int v, ReferencePoint& point) {
  constexpr int distance = 4;
  if (u < distance || v < distance || u >= frame.disparity.width() - distance ||
      v >= frame.disparity.height() - distance) {
    return;
  }
  const double left = frame.disparity(u - distance, v), right = frame.disparity(u + distance, v);
  const double above = frame.disparity(u, v - distance), below = frame.disparity(u, v + distance);
  // NaN compares false.
  point.has_slope = std::abs(left + right - 2 * point.disparity) < max_jump_px &&
                    std::abs(above + below - 2 * point.disparity) < max_jump_px;
  if (!point.has_slope) return;
  point.slope_u = (right - left) / (2 * distance);
  point.slope_v = (below - above) / (2 * distance);
}

/// Pixel of level 0 nearest to the centre of a pixel of level n.
int full_pixel(int x, int level, int size) {
  return std::min(((2 * x + 1) << level) / 2, size - 1);
}

class Selector {
 public:
  Selector(const LinkMaps& frame, int level) : frame_(frame), level_(level), grey_(frame.pyramid.level(level)) {}

  struct Pixel {
    int u = 0, v = 0;
    float strength = -1;  ///< of the gradient, squared; −1: none
  };

  /// The most textured pixel of every cell between rows v0 and v1, off the border, that has a disparity.
  void strongest(int v0, int v1, int side, int margin, std::vector<Pixel>& best) {
    best.assign(static_cast<std::size_t>((grey_.width() + side - 1) / side), {});
    strength_.resize(static_cast<std::size_t>(grey_.width()));
    const auto least = static_cast<float>(-frame_.disparity_offset_px);
    for (int v = v0; v < v1; ++v) {
      find_strength(v);
      const int full_v = full_pixel(v, level_, frame_.disparity.height());
      for (std::size_t cell = 0; cell < best.size(); ++cell) {
        Pixel& pixel = best[cell];
        const int first = static_cast<int>(cell) * side;
        const int last = std::min(first + side, grey_.width() - margin);
        for (int u = std::max(first, margin); u < last; ++u) {
          const float strength = strength_[static_cast<std::size_t>(u)];
          if (strength <= pixel.strength) continue;
          if (!(frame_.disparity(full_pixel(u, level_, frame_.disparity.width()), full_v) > least)) continue;
          pixel = {u, v, strength};
        }
      }
    }
  }

  ReferencePoint point(int u, int v) const {
    const int scale = 1 << level_;
    const int full_u = full_pixel(u, level_, frame_.disparity.width());
    const int full_v = full_pixel(v, level_, frame_.disparity.height());
    ReferencePoint point;
    point.u = (u + 0.5) * scale - 0.5;
    point.v = (v + 0.5) * scale - 0.5;
    point.disparity = frame_.disparity(full_u, full_v);
    point.sigma_px = frame_.sigma(full_u, full_v);
    point.grey = static_cast<double>(static_cast<float>(grey_.row(v)[u]) * grey_unit);
    point.cell = full_v / error_cell * cells_per_row(frame_) + full_u / error_cell;
    find_slopes(frame_, full_u, full_v, point);
    if (point.has_slope) {  // from the pixel that has the disparity to the centre of the coarse one
      point.disparity += point.slope_u * (point.u - full_u) + point.slope_v * (point.v - full_v);
    }
    return point;
  }

  static int cells_per_row(const LinkMaps& frame) { return (frame.disparity.width() + error_cell - 1) / error_cell; }

 private:
  void find_strength(int v) {
    const std::int16_t* row = grey_.row(v);
    const std::int16_t* above = grey_.row(v - 1);
    const std::int16_t* below = grey_.row(v + 1);
    float* strength = strength_.data();
    for (int u = 1; u < grey_.width() - 1; ++u) {
      const auto per_column = static_cast<float>(row[u + 1] - row[u - 1]);
      const auto per_row = static_cast<float>(below[u] - above[u]);
      strength[u] = per_column * per_column + per_row * per_row;
    }
  }

  const LinkMaps& frame_;
  int level_;
  ImageView<const std::int16_t> grey_;
  std::vector<float> strength_;  // of a row
};

/// `margin` ≥ 1: pixels at the border that are not taken.
template <class Take>
void for_each_cell(const LinkMaps& frame, int level, int count, int margin, const Take& take) {
  const ImageView<const std::int16_t> grey = frame.pyramid.level(level);
  Selector selector(frame, level);
  const int side = cell_side(grey.width(), grey.height(), count);
  std::vector<Selector::Pixel> cells;
  for (int v = 0; v < grey.height(); v += side) {
    selector.strongest(std::max(v, margin), std::min(v + side, grey.height() - margin), side, margin, cells);
    for (const Selector::Pixel& pixel : cells) {
      if (pixel.strength >= 0) take(selector, pixel.u, pixel.v);
    }
  }
}

/// The patch around a pixel that is farther than its radius from the border; false without texture.
bool fill_patch(ImageView<const std::int16_t> grey, int u, int v, TexturePatch& patch) {
  constexpr int radius = TexturePatch::radius;
  std::size_t i = 0;
  std::int64_t uu = 0, uv = 0, vv = 0;
  for (int y = v - radius; y <= v + radius; ++y) {
    const std::int16_t* row = grey.row(y);
    const std::int16_t* above = grey.row(y - 1);
    const std::int16_t* below = grey.row(y + 1);
    for (int x = u - radius; x <= u + radius; ++x) {
      const std::int64_t per_column = row[x + 1] - row[x - 1], per_row = below[x] - above[x];
      patch.grey[i++] = static_cast<float>(row[x]) * grey_unit;
      uu += per_column * per_column;
      uv += per_column * per_row;
      vv += per_row * per_row;
    }
  }
  const auto trace = static_cast<double>(uu + vv);
  if (!(trace > 0)) return false;
  patch.uu = static_cast<double>(uu) / trace;
  patch.uv = static_cast<double>(uv) / trace;
  patch.vv = static_cast<double>(vv) / trace;
  return true;
}

void select_patches(const LinkMaps& frame, int level, std::vector<TexturePatch>& patches) {
  patches.clear();
  for_each_cell(frame, level, max_patches, TexturePatch::radius + 1, [&](const Selector& selector, int u, int v) {
    TexturePatch patch;
    patch.point = selector.point(u, v);
    if (patch.point.has_slope && patch.point.sigma_px > 0 && fill_patch(frame.pyramid.level(level), u, v, patch))
      patches.push_back(patch);
  });
}

}  // namespace

void select_points(const LinkMaps& frame, ReferencePoints& points) {
  points.levels.resize(static_cast<std::size_t>(frame.pyramid.levels()));
  for (int level = 0; level < frame.pyramid.levels(); ++level) {
    std::vector<ReferencePoint>& selected = points.levels[static_cast<std::size_t>(level)];
    selected.clear();
    for_each_cell(frame, level, level == 0 ? max_points : max_coarse_points, 1,
                  [&](const Selector& selector, int u, int v) {
                    const ReferencePoint point = selector.point(u, v);
                    if (point.has_slope && point.sigma_px > 0) selected.push_back(point);
                  });
  }
  points.patches.resize(points.levels.size() - 1);
  for (int level = 1; level < frame.pyramid.levels(); ++level) {
    select_patches(frame, level, points.patches[static_cast<std::size_t>(level - 1)]);
  }
  points.cells = Selector::cells_per_row(frame) * ((frame.disparity.height() + error_cell - 1) / error_cell);
}

}  // namespace roadstereo
