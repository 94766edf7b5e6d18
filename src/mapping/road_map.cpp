#include "roadstereo/road_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "core/parallel.hpp"
#include "core/require_range.hpp"
#include "core/round_length.hpp"
#include "mapping/frame_projection.hpp"
#include "mapping/tile_store.hpp"
#include "roadstereo/ground_plane.hpp"

namespace roadstereo {
namespace {

int floor_divide(int value, int divisor) {
  return value >= 0 ? value / divisor : -((divisor - 1 - value) / divisor);
}

/// Tiles of a box: columns and rows, the last ones inside.
struct TileRange {
  int column0, row0, column1, row1;

  TileRange(const MapBox& box, int side)
      : column0(floor_divide(box.i0, side)),
        row0(floor_divide(box.j0, side)),
        column1(floor_divide(box.i0 + box.columns - 1, side)),
        row1(floor_divide(box.j0 + box.rows - 1, side)) {}
};

constexpr double min_cell_m = 0.0005, max_cell_m = 10;

/// A rotation, and a translation that is finite.
void require_rigid(const RigidTransform& t) {
  constexpr double tolerance = 1e-3;
  const double error = std::max(std::abs(determinant(t) - 1), rotation_error(t));
  if (!(error <= tolerance)) {
    fail("camera_to_map is no rigid motion: its rotation is off by ", error, "; at most ", tolerance, " are allowed");
  }
  for (const std::size_t k : {3, 7, 11}) {
    if (!std::isfinite(t[k])) fail("camera_to_map has the translation ", t[k], " m; it must be finite");
  }
}

void require_frame(const MapFrame& frame) {
  const int width = frame.disparity.width(), height = frame.disparity.height();
  if (width < 2 || height < 2) fail("the disparity map has ", width, "×", height, " pixels; it must have at least 2×2");
  if (frame.sigma.width() != width || frame.sigma.height() != height) {
    fail("the map of standard errors has ", frame.sigma.width(), "×", frame.sigma.height(), " pixels; it must have ",
         width, "×", height, " like the disparity map");
  }
  if (frame.image.data == nullptr || frame.image.width != width || frame.image.height != height) {
    fail("the image has ", frame.image.width, "×", frame.image.height, " pixels; it must have ", width, "×", height,
         " like the disparity map");
  }
  frame.calibration.validate(width, height, "calibration");
  require_rigid(frame.camera_to_map);
}

void require_box(const MapBox& box) {
  constexpr std::int64_t max_cells = std::int64_t{1} << 28;
  const auto is_inside = [](std::int64_t first, std::int64_t count) {
    return first >= -max_map_cell && first + count <= max_map_cell;
  };
  if (box.columns >= 0 && box.rows >= 0 && is_inside(box.i0, box.columns) && is_inside(box.j0, box.rows) &&
      std::int64_t{box.columns} * box.rows <= max_cells) {
    return;
  }
  fail("a box has ", box.columns, "×", box.rows, " cells from (", box.i0, ", ", box.j0,
       ") on; it must have none that is negative, at most ", max_cells, ", and lie between ", -max_map_cell, " and ",
       max_map_cell);
}

std::uint8_t byte_of(float grey) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(grey, 0.0F, 255.0F)));
}

}  // namespace

void RoadMapOptions::validate() const {
  require_range("map", "cell_m", cell_m, min_cell_m, max_cell_m);
  require_range("map", "tile_cells", tile_cells, 16, 1024);
  require_range("map", "max_tiles", max_tiles, 4, 1 << 20);
  require_range("map", "max_above_m", max_above_m, 0.0, 100.0);
  require_range("map", "max_below_m", max_below_m, 0.0, 100.0);
  require_range("map", "max_footprint_cells", max_footprint_cells, 1.0, 1000.0);
  require_range("map", "gate_sigmas", gate_sigmas, 1.0, 100.0);
  require_range("map", "common_share", common_share, 0.0, 1.0);
  resolve_threads(threads);
}

struct RoadMap::State {
  State(const std::filesystem::path& folder, const RoadMapOptions& given, const TileStore::Saved& saved = {})
      : options(given), store(folder, given.tile_cells, given.max_tiles, saved) {}

  RoadMapOptions options;
  TileStore store;
  ViewErrorSums sums;
  std::vector<std::optional<CellMeasurement>> seen;  ///< by the frame that is added, of a tile
  bool backwards = false;  ///< order of the tiles of the next frame: the last ones of this one are still in memory
};

RoadMap::RoadMap(const std::filesystem::path& folder, const RoadMapOptions& options) {
  options.validate();
  state_ = std::make_unique<State>(folder, options);
}
RoadMap::RoadMap(const std::filesystem::path& folder, const RoadMapOptions& options, const SavedMap& saved) {
  options.validate();
  TileStore::Saved tiles;
  for (const auto& [column, row, generation] : saved.tiles) tiles[{column, row}] = generation;
  state_ = std::make_unique<State>(folder, options, tiles);
  state_->sums = {saved.sums[0], saved.sums[1], saved.sums[2]};
}
RoadMap::~RoadMap() = default;
RoadMap::RoadMap(RoadMap&&) noexcept = default;
RoadMap& RoadMap::operator=(RoadMap&&) noexcept = default;

std::size_t RoadMap::add(const MapFrame& frame) {
  require_frame(frame);
  const RoadMapOptions& options = state_->options;
  const FrameProjection projection(frame, options);
  const MapBox box = projection.footprint();
  if (box.empty()) return 0;
  require_box(box);
  constexpr int rows_per_band = 8;
  const int side = options.tile_cells;
  const TileRange range(box, side);
  const auto sigmas = static_cast<float>(options.gate_sigmas);
  const auto cell_m = static_cast<float>(options.cell_m);
  std::size_t cells = 0;
  state_->seen.resize(static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
  std::vector<std::size_t> row_cells(static_cast<std::size_t>(side));
  std::vector<ViewErrorSums> row_sums(static_cast<std::size_t>(side));
  const int columns = range.column1 - range.column0 + 1, tiles = columns * (range.row1 - range.row0 + 1);
  std::vector<ViewErrorSums> sums(static_cast<std::size_t>(tiles));
  for (int k = 0; k < tiles; ++k) {
    const int tile_index = state_->backwards ? tiles - 1 - k : k;
    const int row = range.row0 + tile_index / columns, column = range.column0 + tile_index % columns;
    const int i0 = std::max(box.i0, column * side), i1 = std::min(box.i0 + box.columns, (column + 1) * side);
    const int j0 = std::max(box.j0, row * side), j1 = std::min(box.j0 + box.rows, (row + 1) * side);
    const auto line = [&](int j) {  // index of column 0 of the map in row j of the tile
      return static_cast<std::ptrdiff_t>(j - row * side) * side - static_cast<std::ptrdiff_t>(column) * side;
    };
    std::fill(row_cells.begin(), row_cells.end(), 0);
    parallel_rows(j1 - j0, rows_per_band, options.threads, [&](int first, int last, int) {
      for (int j = j0 + first; j < j0 + last; ++j) {
        for (int i = i0; i < i1; ++i) {
          auto& seen = state_->seen[static_cast<std::size_t>(line(j) + i)];
          seen = projection.measure((i + 0.5) * options.cell_m, (j + 0.5) * options.cell_m);
          if (seen) ++row_cells[static_cast<std::size_t>(j - row * side)];
        }
      }
    });
    const std::size_t count = std::accumulate(row_cells.begin(), row_cells.end(), std::size_t{0});
    if (count == 0) continue;  // a corner of the box that the frame does not show
    cells += count;
    TileStore::Cells& tile = state_->store.write({column, row});
    std::fill(row_sums.begin(), row_sums.end(), ViewErrorSums{});
    parallel_rows(j1 - j0, rows_per_band, options.threads, [&](int first, int last, int) {
      for (int j = j0 + first; j < j0 + last; ++j) {
        for (int i = i0; i < i1; ++i) {
          const auto index = static_cast<std::size_t>(line(j) + i);
          const auto& seen = state_->seen[index];
          if (seen) tile[index].add(*seen, sigmas, cell_m, row_sums[static_cast<std::size_t>(j - row * side)]);
        }
      }
    });
    for (const ViewErrorSums& of_row : row_sums) sums[static_cast<std::size_t>(tile_index)].add(of_row);
  }
  for (const ViewErrorSums& of_tile : sums) state_->sums.add(of_tile);
  state_->backwards = !state_->backwards;
  return cells;
}

SavedMap RoadMap::save() {
  SavedMap saved;
  for (const auto& [key, generation] : state_->store.save()) saved.tiles.push_back({key.first, key.second, generation});
  saved.sums = {state_->sums.spread, state_->sums.differences, state_->sums.count};
  return saved;
}

void RoadMap::commit() {
  state_->store.commit();
}

void RoadMap::keep() {
  state_->store.keep();
}

MapBox RoadMap::bounds() const {
  const auto& keys = state_->store.keys();
  if (keys.empty()) return {};
  int column0 = std::numeric_limits<int>::max(), column1 = std::numeric_limits<int>::min();
  int row0 = column0, row1 = column1;
  for (const auto& [key, generation] : keys) {
    column0 = std::min(column0, key.first);
    column1 = std::max(column1, key.first);
    row0 = std::min(row0, key.second);
    row1 = std::max(row1, key.second);
  }
  const int side = state_->options.tile_cells;
  return {column0 * side, row0 * side, (column1 - column0 + 1) * side, (row1 - row0 + 1) * side};
}

std::vector<MapBox> RoadMap::tile_boxes() const {
  const int side = state_->options.tile_cells;
  std::vector<MapBox> boxes;
  for (const auto& [key, generation] : state_->store.keys()) {
    boxes.push_back({key.first * side, key.second * side, side, side});
  }
  return boxes;
}

MapRaster RoadMap::read(const MapBox& box) const {
  require_box(box);
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  MapRaster raster;
  raster.box = box;
  raster.height.assign(box.columns, box.rows, nan);
  raster.sigma.assign(box.columns, box.rows, nan);
  raster.colour.assign(box.columns, box.rows, {0, 0, 0});
  raster.views.assign(box.columns, box.rows, 0);
  if (box.empty()) return raster;
  const int side = state_->options.tile_cells;
  const TileRange range(box, side);
  const ViewErrors errors = state_->sums.errors();
  for (int row = range.row0; row <= range.row1; ++row) {
    for (int column = range.column0; column <= range.column1; ++column) {
      const TileStore::Cells* tile = state_->store.read({column, row});
      if (tile == nullptr) continue;
      const int i0 = std::max(box.i0, column * side), i1 = std::min(box.i0 + box.columns, (column + 1) * side);
      const int j0 = std::max(box.j0, row * side), j1 = std::min(box.j0 + box.rows, (row + 1) * side);
      for (int j = j0; j < j1; ++j) {
        const int v = box.j0 + box.rows - 1 - j;
        for (int i = i0; i < i1; ++i) {
          const MapCell& cell = (*tile)[static_cast<std::size_t>(j - row * side) * static_cast<std::size_t>(side) +
                                        static_cast<std::size_t>(i - column * side)];
          if (cell.surface.views == 0) continue;
          const int u = i - box.i0;
          raster.height(u, v) = cell.surface.mean;
          raster.sigma(u, v) =
              static_cast<float>(std::sqrt(cell.surface.variance(errors, state_->options.common_share)));
          raster.views(u, v) = cell.surface.views;
          raster.colour(u, v) = {byte_of(cell.colour[0]), byte_of(cell.colour[1]), byte_of(cell.colour[2])};
        }
      }
    }
  }
  return raster;
}

const RoadMapOptions& RoadMap::options() const {
  return state_->options;
}

double RoadMap::view_factor() const {
  const double r = state_->sums.errors().correlation;
  return (1 + r) / (1 - r);
}

std::size_t RoadMap::tiles() const {
  return state_->store.keys().size();
}

double suggested_cell_m(const DisparityPlane& road, const StereoCalibration& calibration, int width, int height) {
  constexpr int step = 8;
  const double camera_height_m = ground_plane(road, calibration).height_m;
  std::vector<double> sizes;
  for (int v = 0; v < height; v += step) {
    for (int u = 0; u < width; u += step) {
      const double disparity = road.disparity(u, v) + calibration.disparity_offset_px;
      if (!(disparity > 0)) continue;
      const double z = calibration.focal_px * calibration.baseline_m / disparity;
      sizes.push_back(std::sqrt(z * z * z / camera_height_m) / calibration.focal_px);  // √(Z/f · Z²/(f·h))
    }
  }
  if (sizes.empty()) fail("the road is not in view of the ", width, "×", height, " pixels");
  const auto nearest = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 8);  // the middle of the quarter
  std::nth_element(sizes.begin(), nearest, sizes.end());
  return std::clamp(round_length(*nearest), min_cell_m, max_cell_m);
}

RigidTransform camera_to_road(const DisparityPlane& road, const StereoCalibration& calibration) {
  const RoadAxes axes = road_axes(ground_plane(road, calibration));
  const std::array<double, 3> camera = axes.to_road({0, 0, 0});
  return {axes.x[0], axes.x[1], axes.x[2], camera[0], axes.y[0], axes.y[1],
          axes.y[2], camera[1], axes.z[0], axes.z[1], axes.z[2], camera[2]};
}

}  // namespace roadstereo
