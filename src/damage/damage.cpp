#include "roadstereo/damage.hpp"

#include <algorithm>
#include <limits>

#include "core/parallel.hpp"
#include "core/require_range.hpp"
#include "damage/candidates.hpp"
#include "damage/cells.hpp"
#include "damage/common_view.hpp"
#include "damage/damage_maps.hpp"
#include "damage/depth_cells.hpp"
#include "damage/measurement.hpp"
#include "damage/road_region.hpp"
#include "damage/road_surface.hpp"
#include "damage/ruts.hpp"
#include "damage/smoothing_error.hpp"
#include "damage/surface_correlation.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo {
namespace {

template <class Value>
void require_size(ImageView<Value> view, ImageView<const float> transformed, const char* name) {
  if (view.empty() || (view.width() == transformed.width() && view.height() == transformed.height())) return;
  fail("the ", name, " has ", view.width(), "×", view.height(), " pixels; it must have ", transformed.width(), "×",
       transformed.height(), " like the transformed map");
}

void require_input(const DamageInput& input) {
  constexpr int min_size = 32;
  const auto& map = input.transformed;
  if (map.width() < min_size || map.height() < min_size) {
    fail("the transformed map has ", map.width(), "×", map.height(), " pixels; it must have at least ", min_size, "×",
         min_size);
  }
  require_size(input.disparity, map, "disparity map");
  require_size(input.matched, map, "map of matched disparities");
  require_size(input.sigma, map, "map of standard errors");
  require_size(input.grey, map, "image");
  require_size(input.right, map, "right image");
  require_size(input.mask, map, "mask");
  require_range("damage", "smoothing_px", input.smoothing_px, 0, 32);
  if (input.calibration) input.calibration->validate(map.width(), map.height(), "calibration");
}

/// Reason why results cannot be metric; empty if they can.
std::string reason_for_pixels(const DamageInput& input) {
  if (!input.calibration) return "there is no calibration";
  if (input.disparity.empty()) return "there is no disparity map";
  if (!input.plane) return "the plane of the road is not available";
  return {};
}

/// Fit the road surface without `ruts`, which are found first, by alternating between it and the road region, and move
/// the cells that the images do not support onto it before the last fit.
RoadSurface find_road_surface(const DamageInput& input, const SurfaceCoordinates& coordinates, double mount_yaw_deg,
                              int threads, Cells& cells, Ruts& ruts) {
  RoadSurface surface = fit_road_surface(cells, coordinates, threads);
  ruts = find_ruts(cells, coordinates, surface, mount_yaw_deg, threads);
  const auto refit = [&](Sampling sampling) {
    Image<std::uint8_t> region = find_road_region(cells, coordinates, surface, ruts, 0, threads);
    ruts.fill(0, region);
    surface = refit_road_surface(cells, coordinates, region, surface, sampling, threads);
  };
  refit(Sampling::coarse);
  move_unsupported_cells(input, surface, threads, cells);
  refit(Sampling::fine);
  return surface;
}

ImageEdges make_image_edges(const DamageInput& input, const Cells& cells) {
  constexpr int window_radius_px = SmoothingError::window_radius_px;
  return {input.grey, cells.factor, (window_radius_px + cells.factor - 1) / cells.factor};
}

/// Find the candidates, and fill the maps of `result` regardless of them meanwhile. Threads that have no rows left help
/// with the candidates.
void search_and_fill(const DamageInput& input, const DamageOptions& options, const Thresholds& thresholds,
                     const Ruts& ruts, DepthCells& depth_cells, int threads, Segmentation& segmentation,
                     std::optional<FrameGeometry>& geometry, DamageMap& result) {
  constexpr int rows_per_band = 64;
  const int width = input.transformed.width(), height = input.transformed.height();
  resize_maps(width, height, result);
  const int bands = (height + rows_per_band - 1) / rows_per_band;
  parallel_for(bands + 2, threads, [&](int task, int) {
    if (task == 0) {
      segmentation.candidates =
          find_candidates(depth_cells, segmentation.road, segmentation.view, ruts, segmentation.coordinates, thresholds,
                          make_image_edges(input, segmentation.cells), options.protrusions, threads);
    } else if (task == 1) {
      if (FrameGeometry::is_possible(input)) geometry.emplace(input);
    } else {
      const int first = (task - 2) * rows_per_band;
      fill_road_rows(input, segmentation, first, std::min(first + rows_per_band, height), result);
    }
  });
}

}  // namespace

void DamageOptions::validate() const {
  require_range("damage", "threshold_sigma", threshold_sigma, 1.0, 100.0);
  require_range("damage", "min_depth_m", min_depth_m, 0.0, 10.0);
  require_range("damage", "max_depth_m", max_depth_m, min_depth_m, 10.0);
  require_range("damage", "max_height_m", max_height_m, min_depth_m, 10.0);
  require_range("damage", "min_area_m2", min_area_m2, 0.0, 1e4);
  require_range("damage", "min_area_share", min_area_share, 0.0, 1.0);
  require_range("damage", "min_confidence", min_confidence, 0.0, 1.0);
  require_range("damage", "mount_yaw_deg", mount_yaw_deg, -360.0, 360.0);
  severity.validate();
}

DamageMap make_empty_damage_map(int width, int height, const std::string& reason) {
  DamageMap none;
  none.ids.assign(width, height, 0);
  none.road.assign(width, height, 0);
  none.surface.assign(width, height, std::numeric_limits<float>::quiet_NaN());
  none.depth = none.surface;
  none.non_metric_reason = reason;
  return none;
}

DamageMap find_damage(const DamageInput& input, const DamageOptions& options, int threads) {
  DamageMap result;
  find_damage(input, options, threads, result);
  return result;
}

void find_damage(const DamageInput& input, const DamageOptions& options, int threads, DamageMap& result) {
  options.validate();
  require_input(input);
  Cells cells = make_cells(input.transformed, input.sigma, input.smoothing_px,
                           cell_factor(input.transformed.width(), input.transformed.height()), threads);
  const CommonView view(input, cells);
  view.remove_outside(cells);
  const SurfaceCoordinates coordinates = surface_coordinates(cells, input, threads);
  Ruts ruts;
  const RoadSurface surface = find_road_surface(input, coordinates, options.mount_yaw_deg, threads, cells, ruts);
  DepthCells depth_cells = make_depth_cells(cells, surface, threads);
  result.non_metric_reason = reason_for_pixels(input);
  result.metric = result.non_metric_reason.empty();
  result.noise_px = surface.noise;
  const Thresholds thresholds(input, options, cells, coordinates, depth_cells.noise, result.metric);
  const Image<std::uint8_t> road = find_road_region(cells, coordinates, surface, ruts, thresholds.relief_m(), threads);
  Segmentation segmentation{cells, view, coordinates, surface, road, depth_cells, {}};
  std::optional<FrameGeometry> geometry;
  search_and_fill(input, options, thresholds, ruts, depth_cells, threads, segmentation, geometry, result);
  measure_damage(input, options, segmentation, geometry, threads, result);
}

}  // namespace roadstereo
