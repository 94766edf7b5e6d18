#include "roadstereo/map_damage.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <set>

#include "core/degrees.hpp"
#include "core/order_statistics.hpp"
#include "mapping/bounds_index.hpp"
#include "mapping/footprints.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/roll.hpp"

namespace roadstereo {
namespace {

constexpr double median_sigma_px = 0.1;  ///< of the map, seen by the virtual rig
constexpr double road_px = 64;           ///< disparity of the window's plane
constexpr double delta_t_px = 10;        ///< transformed disparity of the window's plane

/// Cells of the footprint of a damage: those of its pixels' centres, and all between them where a pixel covers several.
/// `place(u, v)` is the position in the map of a point of the image; it keeps lines straight.
template <class Place>
MapCells footprint_of(const Damage& damage, const DamageMap& found, const Place& place) {
  MapCells cells;
  for (int v = damage.box_px[1]; v <= damage.box_px[3]; ++v) {
    int run = 0;  // pixels of the damage up to u
    for (int u = damage.box_px[0]; u <= damage.box_px[2] + 1; ++u) {
      if (u <= damage.box_px[2] && found.ids(u, v) == damage.id) {
        const std::array<double, 2> at = place(u, v);
        cells.push_back({static_cast<std::int32_t>(std::floor(at[0] / footprint_m)),
                         static_cast<std::int32_t>(std::floor(at[1] / footprint_m))});
        ++run;
      } else if (run > 0) {
        const double left = u - run - 0.5, right = u - 0.5;
        add_cells_inside({place(left, v - 0.5), place(right, v - 0.5), place(right, v + 0.5), place(left, v + 0.5)},
                         cells);
        run = 0;
      }
    }
  }
  std::sort(cells.begin(), cells.end(), cell_less);
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  return cells;
}

/// A part of the map as a rig that looks straight down sees it.
struct WindowView {
  MapRaster raster;
  DamageInput input;
  Image<float> transformed, disparity, sigma;
};

double median_sigma(const Image<float>& sigma) {
  std::vector<float> values;
  const float* const first = sigma.row(0);
  std::copy_if(first, first + sigma.pixels(), std::back_inserter(values), [](float s) { return std::isfinite(s); });
  return values.empty() ? 0 : static_cast<double>(upper_median(values));
}

/// Virtual rig: cell = Z/f, and about `scale` pixels of disparity per metre of height, f·b/Z².
StereoCalibration virtual_rig(int side, double cell_m, double scale) {
  constexpr double most_m = 9, min_baseline_m = 0.01, max_focal_widths = 40, min_focal_widths = 0.2;
  const double max_baseline_m = std::min(most_m, 0.9 * side * cell_m);  // the disparity offset stays below the width
  StereoCalibration rig;
  rig.width = rig.height = side;
  rig.cx_px = rig.cy_px = 0.5 * (side - 1);
  rig.focal_px =
      std::clamp(max_baseline_m / (scale * cell_m * cell_m), min_focal_widths * side, max_focal_widths * side);
  rig.baseline_m = std::clamp(scale * rig.focal_px * cell_m * cell_m, min_baseline_m, max_baseline_m);
  rig.disparity_offset_px = rig.baseline_m / cell_m - road_px;  // f·b/Z of the plane, Z = f·cell
  return rig;
}

/// Nothing if the window shows too little road.
bool make_view(const RoadMap& map, const MapBox& box, WindowView& view) {
  constexpr std::size_t min_share = 50;  // of the window: one in so many cells
  view.raster = map.read(box);
  const MapRaster& raster = view.raster;
  const float* const heights = raster.height.row(0);
  const auto valid = static_cast<std::size_t>(
      std::count_if(heights, heights + raster.height.pixels(), [](float height) { return std::isfinite(height); }));
  if (valid * min_share < raster.height.pixels()) return false;
  const double scale = median_sigma_px / median_sigma(raster.sigma);
  const StereoCalibration rig = virtual_rig(box.columns, map.options().cell_m, scale);
  rig.validate(box.columns, box.rows, "the rig that sees the map");
  Image<float> scaled(box.columns, box.rows);
  std::transform(heights, heights + raster.height.pixels(), scaled.row(0),
                 [&](float height) { return static_cast<float>(height * scale); });
  DisparityPlane plane;
  try {
    plane = estimate_roll(scaled, {}, std::nullopt, 0, {}, map.options().threads).plane;
  } catch (const SystemError&) {
    throw;
  } catch (const Error&) {  // all cells lie on one line
    return false;
  }
  const double z = rig.focal_px * map.options().cell_m, px_per_m = rig.focal_px * rig.baseline_m / (z * z);
  view.transformed.resize(box.columns, box.rows);
  view.disparity.resize(box.columns, box.rows);
  view.sigma.resize(box.columns, box.rows);
  for (int v = 0; v < box.rows; ++v) {
    for (int u = 0; u < box.columns; ++u) {
      const double height = raster.height(u, v) - plane.disparity(u, v) / scale;
      const double disparity = rig.focal_px * rig.baseline_m / (z - height) - rig.disparity_offset_px;
      view.disparity(u, v) = static_cast<float>(disparity);
      view.transformed(u, v) = static_cast<float>(disparity - road_px + delta_t_px);
      view.sigma(u, v) = static_cast<float>(raster.sigma(u, v) * px_per_m);
    }
  }
  view.input.transformed = view.transformed;
  view.input.disparity = view.disparity;
  view.input.sigma = view.sigma;
  view.input.plane = DisparityPlane{road_px, 0, 0};
  view.input.calibration = rig;
  return true;
}

MapDamage map_damage(const Damage& damage, const DamageMap& found, const MapBox& box, double cell_m) {
  MapDamage result;
  result.damage = damage;
  const auto x = [&](double u) { return (box.i0 + u + 0.5) * cell_m; };
  const auto y = [&](double v) { return (box.j0 + box.rows - v - 0.5) * cell_m; };
  result.at_m = {x(damage.centroid_px[0]), y(damage.centroid_px[1])};
  result.length_angle_rad = damage.metrics->angle_rad;
  result.footprint = footprint_of(damage, found, [&](double u, double v) { return std::array<double, 2>{x(u), y(v)}; });
  return result;
}

/// Whether two findings are of one damage; neighbours may share a few footprint cells.
bool overlap(const MapDamage& one, const MapDamage& other) {
  return one.damage.kind == other.damage.kind && overlap_share(one.footprint, other.footprint) >= min_overlap_share;
}

/// Takes of two findings in overlapping windows the one that is not cut, or else the larger.
void add_finding(MapDamage finding, std::vector<MapDamage>& findings, BoundsIndex& index) {
  const CellBounds bounds = bounds_of(finding.footprint);
  for (const std::size_t i : index.near(bounds)) {
    MapDamage& known = findings[i];
    if (!overlap(known, finding)) continue;
    const bool better = known.damage.cut_by_border != finding.damage.cut_by_border
                            ? known.damage.cut_by_border
                            : finding.footprint.size() > known.footprint.size();
    if (better) {
      known = std::move(finding);
      index.add(i, bounds);
    }
    return;
  }
  index.add(findings.size(), bounds);
  findings.push_back(std::move(finding));
}

/// Windows of side × side cells, half of which overlap the next, that have tiles, row by row. The last of a row or
/// column is the one that holds the border with a quarter to spare.
std::vector<MapBox> windows_of(const RoadMap& map, int side) {
  const MapBox bounds = map.bounds();
  const int step = side / 2, i0 = bounds.i0 - side / 4, j0 = bounds.j0 - side / 4;
  const int i1 = bounds.i0 + bounds.columns - side / 4, j1 = bounds.j0 + bounds.rows - side / 4;
  const auto first_with = [&](int at, int start) { return at < start + side ? 0 : (at - start - side) / step + 1; };
  std::set<std::array<int, 2>> corners;  // row and column of the first cell
  for (const MapBox& tile : map.tile_boxes()) {
    for (int j = j0 + first_with(tile.j0, j0) * step; j < std::min(tile.j0 + tile.rows, j1); j += step) {
      for (int i = i0 + first_with(tile.i0, i0) * step; i < std::min(tile.i0 + tile.columns, i1); i += step) {
        corners.insert({j, i});
      }
    }
  }
  std::vector<MapBox> windows;
  windows.reserve(corners.size());
  for (const auto& [j, i] : corners) windows.push_back({i, j, side, side});
  return windows;
}

/// Mean direction of the paths within `near_m` of a place, degrees clockwise from y, −90 … 90, of both ways of each;
/// nothing if there is none.
std::optional<double> azimuth_near(const std::array<double, 2>& place, double near_m,
                                   std::span<const std::vector<std::array<double, 2>>> paths) {
  double sum_sine = 0, sum_cosine = 0;  // of twice the angle
  for (const auto& path : paths) {
    for (std::size_t i = 1; i < path.size(); ++i) {
      const double dx = path[i][0] - path[i - 1][0], dy = path[i][1] - path[i - 1][1], length_m = std::hypot(dx, dy);
      const double away_m =
          std::hypot(0.5 * (path[i][0] + path[i - 1][0]) - place[0], 0.5 * (path[i][1] + path[i - 1][1]) - place[1]);
      if (!(length_m > 0) || away_m > near_m) continue;
      const double weight = length_m * (1 - away_m / near_m), twice = 2 * std::atan2(dx, dy);
      sum_sine += weight * std::sin(twice);
      sum_cosine += weight * std::cos(twice);
    }
  }
  if (sum_sine == 0 && sum_cosine == 0) return std::nullopt;
  return to_degrees(0.5 * std::atan2(sum_sine, sum_cosine));
}

}  // namespace

std::vector<MapDamage> find_map_damage(const RoadMap& map, const DamageOptions& options,
                                       std::span<const std::vector<std::array<double, 2>>> paths) {
  constexpr int usual_side = 1024, min_side = 256;
  constexpr double min_side_m = 4, max_side_m = 10, max_near_m = 1000;
  options.validate();
  const double cell_m = map.options().cell_m;
  const auto cells = [cell_m](double length_m) { return static_cast<int>(std::ceil(length_m / cell_m / 2)) * 2; };
  const int side = std::max({cells(min_side_m), min_side, std::min(usual_side, cells(max_side_m))});
  std::vector<MapDamage> findings;
  BoundsIndex index;
  WindowView view;
  DamageMap found;
  DamageOptions of_window = options;
  for (const MapBox& box : windows_of(map, side)) {
    if (!make_view(map, box, view)) continue;
    const std::array<double, 2> centre_m{(box.i0 + 0.5 * side) * cell_m, (box.j0 + 0.5 * side) * cell_m};
    of_window.mount_yaw_deg = options.mount_yaw_deg;
    for (double near_m = side * cell_m; near_m <= max_near_m; near_m *= 2) {
      const std::optional<double> azimuth_deg = azimuth_near(centre_m, near_m, paths);
      if (!azimuth_deg) continue;
      of_window.mount_yaw_deg = -*azimuth_deg;
      break;
    }
    try {
      find_damage(view.input, of_window, map.options().threads, found);
    } catch (const SystemError&) {
      throw;
    } catch (const Error&) {  // too little of it lies on one surface
      continue;
    }
    for (const Damage& damage : found.damages) {
      if (damage.metrics) add_finding(map_damage(damage, found, box, cell_m), findings, index);
    }
  }
  return findings;
}

std::vector<MapDamage> locate_damage(const DamageMap& found, const DisparityPlane& road,
                                     const StereoCalibration& calibration, const RigidTransform& camera_to_map) {
  const std::array<double, 3> axis = rotate(camera_to_map, road_axes(ground_plane(road, calibration)).x);
  std::vector<MapDamage> located;
  for (const Damage& damage : found.damages) {
    if (!damage.metrics) continue;
    MapDamage result;
    result.damage = damage;
    const std::array<double, 3> centroid = transform_point(camera_to_map, damage.metrics->centroid_m);
    result.at_m = {centroid[0], centroid[1]};
    result.length_angle_rad =
        std::remainder(damage.metrics->angle_rad + std::atan2(axis[1], axis[0]), std::numbers::pi);
    result.footprint = footprint_of(damage, found, [&](double u, double v) {
      const auto at = transform_point(camera_to_map, calibration.point_m(u, v, road.disparity(u, v)));
      return std::array<double, 2>{at[0], at[1]};
    });
    located.push_back(std::move(result));
  }
  return located;
}

}  // namespace roadstereo
