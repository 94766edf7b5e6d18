#include "roadstereo/relief.hpp"

#include <algorithm>
#include <cmath>

#include "core/require_range.hpp"
#include "damage/local_road.hpp"
#include "roadstereo/surroundings.hpp"

namespace roadstereo {
namespace {

/// The pixel of point `i` of `count` spread evenly from `first` to `last`.
int grid_pixel(int first, int last, int i, int count) {
  if (count < 2) return first;
  return first + static_cast<int>(std::lround(static_cast<double>(i) * (last - first) / (count - 1)));
}

/// Puts the middle of the coordinates at 0.
void centre(Image<float>& coordinates) {
  float* const begin = coordinates.row(0);
  float* const end = begin + coordinates.pixels();
  const auto [low, high] = std::minmax_element(begin, end);
  const float middle = (*low + *high) / 2;
  std::for_each(begin, end, [middle](float& value) { value -= middle; });
}

}  // namespace

Relief damage_relief(const DamageMap& map, const Damage& damage, ImageView<const float> disparity,
                     const std::optional<StereoCalibration>& calibration, int most_points) {
  require_same_size(map, disparity);
  require_range("relief", "most_points", most_points, 2, 1000);
  constexpr double share = 0.25;
  constexpr int least_margin_px = 6;
  const PixelBox box = surroundings(map, damage, share, least_margin_px);
  const std::optional<LocalRoad> road = find_local_road(map, damage, disparity, calibration);
  const int columns = std::clamp(box.width(), 2, most_points);  // each for itself: a crack keeps its width
  const int rows = std::clamp(box.height(), 2, most_points);

  Relief relief{road.has_value(), Image<float>(columns, rows), Image<float>(columns, rows), Image<float>(columns, rows),
                Image<std::uint8_t>(columns, rows)};
  for (int row = 0; row < rows; ++row) {
    const int v = grid_pixel(box.v0, box.v1, row, rows);
    for (int column = 0; column < columns; ++column) {
      const int u = grid_pixel(box.u0, box.u1, column, columns);
      const float depth = map.depth(u, v);
      const bool known = std::isfinite(depth);
      const bool measured = known && (disparity.empty() || std::isfinite(disparity(u, v)));
      const std::array<double, 2> at =
          road ? road->at(u, v) : std::array<double, 2>{static_cast<double>(u), static_cast<double>(-v)};
      relief.x(column, row) = static_cast<float>(at[0]);
      relief.y(column, row) = static_cast<float>(at[1]);
      relief.depth(column, row) = depth;
      relief.measured(column, row) = measured ? 255 : 0;
    }
  }
  centre(relief.x);
  centre(relief.y);
  return relief;
}

}  // namespace roadstereo
