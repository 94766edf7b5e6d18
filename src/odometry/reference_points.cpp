#include "odometry/reference_points.hpp"

#include <algorithm>
#include <cmath>

namespace roadstereo {
namespace {

constexpr int max_points = 5000;         // of level 0
constexpr int max_coarse_points = 1500;  // of the other levels
constexpr int max_patches = 400;
constexpr int error_cell = 32;     // pixels: wider than the windows of matching and refinement
constexpr double max_jump_px = 1;  // between neighbouring disparities of one surface

/// Side of square cells of which `count` cover the image.
int cell_side(int width, int height, int count) {
  return std::max(1, static_cast<int>(std::ceil(std::sqrt(static_cast<double>(width) * height / count))));
}

/// Slopes of the disparity from pixels at a distance, when all of them lie on one surface.
void find_slopes(const FrameMaps& frame, int u, int v, ReferencePoint& point) {
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
  Selector(const FrameMaps& frame, int level) : frame_(frame), level_(level), samples_(frame.pyramid.level(level)) {}

  /// The textured pixel of a cell; false when none has a disparity.
  bool strongest(int u0, int v0, int side, int margin, int& best_u, int& best_v) const {
    float strongest = -1;
    const int u1 = std::min(u0 + side, samples_.width() - margin), v1 = std::min(v0 + side, samples_.height() - margin);
    for (int v = std::max(v0, margin); v < v1; ++v) {
      const GreySample* row = samples_.row(v);
      const int full_v = full_pixel(v, level_, frame_.disparity.height());
      for (int u = std::max(u0, margin); u < u1; ++u) {
        const float strength = row[u].per_column * row[u].per_column + row[u].per_row * row[u].per_row;
        if (strength <= strongest) continue;
        if (!(frame_.disparity(full_pixel(u, level_, frame_.disparity.width()), full_v) > 0)) continue;
        strongest = strength;
        best_u = u;
        best_v = v;
      }
    }
    return strongest >= 0;
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
    point.grey = samples_(u, v).grey;
    point.cell = full_v / error_cell * cells_per_row(frame_) + full_u / error_cell;
    find_slopes(frame_, full_u, full_v, point);
    if (point.has_slope) {  // from the pixel that has the disparity to the centre of the coarse one
      point.disparity += point.slope_u * (point.u - full_u) + point.slope_v * (point.v - full_v);
    }
    return point;
  }

  static int cells_per_row(const FrameMaps& frame) { return (frame.disparity.width() + error_cell - 1) / error_cell; }

 private:
  const FrameMaps& frame_;
  int level_;
  const Image<GreySample>& samples_;
};

template <class Take>
void for_each_cell(const FrameMaps& frame, int level, int count, int margin, const Take& take) {
  const Image<GreySample>& samples = frame.pyramid.level(level);
  const Selector selector(frame, level);
  const int side = cell_side(samples.width(), samples.height(), count);
  for (int v = 0; v < samples.height(); v += side) {
    for (int u = 0; u < samples.width(); u += side) {
      int best_u = 0, best_v = 0;
      if (selector.strongest(u, v, side, margin, best_u, best_v)) take(selector, best_u, best_v);
    }
  }
}

/// False for a patch without texture.
bool fill_patch(const Image<GreySample>& samples, int u, int v, TexturePatch& patch) {
  constexpr int radius = TexturePatch::radius;
  std::size_t i = 0;
  for (int y = v - radius; y <= v + radius; ++y) {
    for (int x = u - radius; x <= u + radius; ++x) {
      const GreySample& sample = samples(x, y);
      patch.grey[i++] = sample.grey;
      patch.uu += static_cast<double>(sample.per_column * sample.per_column);
      patch.uv += static_cast<double>(sample.per_column * sample.per_row);
      patch.vv += static_cast<double>(sample.per_row * sample.per_row);
    }
  }
  const double trace = patch.uu + patch.vv;
  if (!(trace > 0)) return false;
  patch.uu /= trace;
  patch.uv /= trace;
  patch.vv /= trace;
  return true;
}

void select_patches(const FrameMaps& frame, int level, std::vector<TexturePatch>& patches) {
  patches.clear();
  for_each_cell(frame, level, max_patches, TexturePatch::radius + 1, [&](const Selector& selector, int u, int v) {
    TexturePatch patch;
    patch.point = selector.point(u, v);
    if (patch.point.has_slope && fill_patch(frame.pyramid.level(level), u, v, patch)) patches.push_back(patch);
  });
}

}  // namespace

void select_points(const FrameMaps& frame, ReferencePoints& points) {
  points.levels.resize(static_cast<std::size_t>(frame.pyramid.levels()));
  for (int level = 0; level < frame.pyramid.levels(); ++level) {
    std::vector<ReferencePoint>& selected = points.levels[static_cast<std::size_t>(level)];
    selected.clear();
    for_each_cell(frame, level, level == 0 ? max_points : max_coarse_points, 1,
                  [&](const Selector& selector, int u, int v) {
                    const ReferencePoint point = selector.point(u, v);
                    if (point.has_slope) selected.push_back(point);
                  });
  }
  points.patches.resize(points.levels.size() - 1);
  for (int level = 1; level < frame.pyramid.levels(); ++level) {
    select_patches(frame, level, points.patches[static_cast<std::size_t>(level - 1)]);
  }
  points.cells = Selector::cells_per_row(frame) * ((frame.disparity.height() + error_cell - 1) / error_cell);
}

bool sample_surface(const FrameMaps& frame, double u, double v, SurfaceSample& sample) {
  const int x = static_cast<int>(std::floor(u)), y = static_cast<int>(std::floor(v));
  if (x < 0 || y < 0 || x + 1 >= frame.disparity.width() || y + 1 >= frame.disparity.height()) return false;
  const float* row = frame.disparity.row(y) + x;
  const float* next = frame.disparity.row(y + 1) + x;
  const float lowest = std::min(std::min(row[0], row[1]), std::min(next[0], next[1]));
  const float highest = std::max(std::max(row[0], row[1]), std::max(next[0], next[1]));
  const double fu = u - x, fv = v - y;
  sample.disparity = (1 - fv) * ((1 - fu) * row[0] + fu * row[1]) + fv * ((1 - fu) * next[0] + fu * next[1]);
  sample.sigma_px = frame.sigma(x + (fu > 0.5 ? 1 : 0), y + (fv > 0.5 ? 1 : 0));
  return !std::isnan(sample.disparity) && highest - lowest < max_jump_px && sample.sigma_px > 0;
}

}  // namespace roadstereo
