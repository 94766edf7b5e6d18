#include "roadstereo/relief.hpp"

#include <algorithm>
#include <cmath>

#include "core/require_range.hpp"
#include "damage/local_ground_plane.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/pixel_box.hpp"

namespace roadstereo {
namespace {

/// Pixel of sample `i` of `count` evenly spaced ones, `first` … `last`.
int grid_pixel(int first, int last, int i, int count) {
  if (count < 2) return first;
  return first + static_cast<int>(std::lround(static_cast<double>(i) * (last - first) / (count - 1)));
}

/// Subtract the middle of the range of the coordinates.
void centre(Image<float>& coordinates) {
  float* const begin = coordinates.row(0);
  float* const end = begin + coordinates.pixels();
  const auto [min, max] = std::minmax_element(begin, end);
  const float middle = (*min + *max) / 2;
  std::for_each(begin, end, [middle](float& value) { value -= middle; });
}

}  // namespace

Relief extract_relief(const DamageMap& map, const Damage& damage, ImageView<const float> disparity,
                      const std::optional<StereoCalibration>& calibration, int max_points) {
  require_same_size(map, disparity);
  if (map.depth.empty()) fail("the damage map is empty; it must be that of find_damage");
  require_range("relief", "max_points", max_points, 2, 1000);
  constexpr double margin_share = 0.25;
  constexpr int min_margin_px = 6;
  const PixelBox box = box_with_margin(map, damage, margin_share, min_margin_px);
  const std::optional<LocalGroundPlane> road = fit_local_ground_plane(map, damage, disparity, calibration);
  const int columns = std::clamp(box.width(), 2, max_points);  // independent of the rows: a crack keeps its width
  const int rows = std::clamp(box.height(), 2, max_points);

  Relief relief{road.has_value(), Image<float>(columns, rows), Image<float>(columns, rows), Image<float>(columns, rows),
                Image<std::uint8_t>(columns, rows)};
  for (int row = 0; row < rows; ++row) {
    const int v = grid_pixel(box.v0, box.v1, row, rows);
    for (int column = 0; column < columns; ++column) {
      const int u = grid_pixel(box.u0, box.u1, column, columns);
      const float depth = map.depth(u, v);
      const bool valid = std::isfinite(depth);
      const bool measured = valid && (disparity.empty() || std::isfinite(disparity(u, v)));
      const std::array<double, 2> position =
          road ? road->road_point(u, v) : std::array<double, 2>{static_cast<double>(u), static_cast<double>(-v)};
      relief.x(column, row) = static_cast<float>(position[0]);
      relief.y(column, row) = static_cast<float>(position[1]);
      relief.depth(column, row) = depth;
      relief.measured(column, row) = measured ? 255 : 0;
    }
  }
  centre(relief.x);
  centre(relief.y);
  return relief;
}

}  // namespace roadstereo
