#include "roadstereo/damage.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/parallel.hpp"
#include "core/require_range.hpp"
#include "damage/candidates.hpp"
#include "damage/cells.hpp"
#include "damage/depth_cells.hpp"
#include "damage/measurement.hpp"
#include "damage/road_region.hpp"
#include "damage/road_surface.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo {
namespace {

template <class Value>
void require_size(ImageView<Value> view, ImageView<const float> transformed, const char* name) {
  if (view.empty() || (view.width() == transformed.width() && view.height() == transformed.height())) return;
  fail("the ", name, " has ", view.width(), "×", view.height(), " pixels and the transformed map ", transformed.width(),
       "×", transformed.height(), "; they must have one size");
}

void require_input(const DamageInput& input) {
  constexpr int least_size = 32;
  const auto& map = input.transformed;
  if (map.width() < least_size || map.height() < least_size) {
    fail("the transformed map has ", map.width(), "×", map.height(), " pixels; at least ", least_size, "×", least_size,
         " are needed");
  }
  require_size(input.disparity, map, "disparity map");
  require_size(input.sigma, map, "map of standard errors");
  require_size(input.grey, map, "image");
  if (input.calibration) input.calibration->validate(map.width(), map.height(), "calibration");
}

/// Why nothing is measured in metres, or nothing.
std::string missing_for_metres(const DamageInput& input) {
  if (!input.calibration) return "there is no calibration";
  if (input.disparity.empty()) return "there is no disparity map";
  if (!input.plane) return "the plane of the road is not known";
  return {};
}

/// The road region and the surface: each is found with the other's help.
void find_road(const Cells& cells, const SurfaceCoordinates& coordinates, RoadSurface& surface,
               Image<std::uint8_t>& road) {
  constexpr int rounds = 2;
  surface = fit_road_surface(cells, coordinates);
  road = find_road_region(cells, surface);
  for (int i = 0; i < rounds; ++i) {
    surface = refit_road_surface(cells, coordinates, road, surface);
    road = find_road_region(cells, surface);
  }
}

/// Depth that counts at each cell: standard errors, or metres where they are more.
Thresholds make_thresholds(const DepthCells& relief, const SurfaceCoordinates& coordinates, const Cells& cells,
                           const DamageInput& input, const DamageOptions& options, bool metric) {
  Thresholds thresholds;
  const auto noise = static_cast<float>(options.threshold_sigma * relief.noise);
  const auto of_image = static_cast<float>(options.min_area_share * static_cast<double>(cells.value.pixels()));
  thresholds.depth.assign(cells.width(), cells.height(), noise);
  thresholds.least_cells.assign(cells.width(), cells.height(), of_image);
  thresholds.deepest.assign(cells.width(), cells.height(), std::numeric_limits<float>::infinity());
  thresholds.highest = thresholds.deepest;
  thresholds.metric = metric;
  if (!metric) return thresholds;
  const RoadPlane plane = road_plane(*input.plane, *input.calibration);
  constexpr double least_pixels = 64;  // fewer is less than matching's window
  const double cell_share = 1.0 / (cells.factor * cells.factor);
  for (int j = 0; j < cells.height(); ++j) {
    for (int i = 0; i < cells.width(); ++i) {
      const auto least = static_cast<float>(options.min_depth_m * coordinates.scale(i, j));
      if (std::isnan(least)) continue;
      thresholds.depth(i, j) = std::max(noise, least);
      thresholds.deepest(i, j) = static_cast<float>(options.max_depth_m * coordinates.scale(i, j));
      thresholds.highest(i, j) = static_cast<float>(options.max_height_m * coordinates.scale(i, j));
      const double u = cells.middle(i);
      const double v = cells.middle(j);
      const double z = input.calibration->depth_m(input.plane->disparity(u, v));
      const double pixel_m2 = z * z * z / (input.calibration->focal_px * input.calibration->focal_px * plane.height_m);
      thresholds.least_cells(i, j) =
          static_cast<float>(std::max(options.min_area_m2 / pixel_m2, least_pixels) * cell_share);
    }
  }
  return thresholds;
}

Witness make_witness(const DamageInput& input, const Cells& cells, int threads) {
  constexpr int window_px = 10;  // radius of the block and of the aggregation
  if (input.grey.empty()) return {};
  return {make_grey_cells(input.grey, cells.factor, threads), (window_px + cells.factor - 1) / cells.factor};
}

}  // namespace

void DamageOptions::validate() const {
  require_range("damage", "threshold_sigma", threshold_sigma, 1.0, 100.0);
  require_range("damage", "min_depth_m", min_depth_m, 0.0, 10.0);
  require_range("damage", "max_depth_m", max_depth_m, min_depth_m, 10.0);
  require_range("damage", "max_height_m", max_height_m, min_depth_m, 10.0);
  require_range("damage", "min_area_m2", min_area_m2, 0.0, 1e4);
  require_range("damage", "min_area_share", min_area_share, 0.0, 1.0);
}

DamageMap no_damage(int width, int height, const std::string& reason) {
  DamageMap none;
  none.ids.assign(width, height, 0);
  none.road.assign(width, height, 0);
  none.surface.assign(width, height, std::numeric_limits<float>::quiet_NaN());
  none.depth = none.surface;
  none.unmetric_reason = reason;
  return none;
}

DamageMap find_damage(const DamageInput& input, const DamageOptions& options, int threads) {
  options.validate();
  require_input(input);
  const Cells cells = make_cells(input.transformed, input.sigma,
                                 cell_factor(input.transformed.width(), input.transformed.height()), threads);
  const SurfaceCoordinates coordinates = surface_coordinates(cells, input);
  RoadSurface surface;
  Image<std::uint8_t> road;
  find_road(cells, coordinates, surface, road);
  const DepthCells relief = make_depth_cells(cells, surface);
  DamageMap result;
  result.unmetric_reason = missing_for_metres(input);
  result.metric = result.unmetric_reason.empty();
  const Thresholds thresholds = make_thresholds(relief, coordinates, cells, input, options, result.metric);
  result.noise_px = surface.noise;
  const Segmentation found{
      cells, surface, road, relief,
      find_candidates(relief, road, thresholds, make_witness(input, cells, threads), options.protrusions)};
  measure_damage(input, options, found, threads, result);
  return result;
}

}  // namespace roadstereo
