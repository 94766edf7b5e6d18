#include "map/day_layers.hpp"

#include <algorithm>

#include "roadstereo/road_relief.hpp"

namespace roadstereo::cli {
namespace {

/// Fills cells that nothing measures with those of an older day.
void fill_gaps(const MapRaster& older, MapRaster& raster) {
  for (int v = 0; v < raster.box.rows; ++v) {
    for (int u = 0; u < raster.box.columns; ++u) {
      if (raster.views(u, v) > 0) continue;
      raster.height(u, v) = older.height(u, v);
      raster.sigma(u, v) = older.sigma(u, v);
      raster.colour(u, v) = older.colour(u, v);
      raster.views(u, v) = older.views(u, v);
    }
  }
}

template <class Read>
io::ReadMap newest(const BuiltMap& built, const Read& read) {
  return [&built, read](const MapBox& box) {
    MapRaster raster = read(built.days.back().map, box);
    for (auto day = built.days.rbegin() + 1; day != built.days.rend(); ++day) fill_gaps(read(day->map, box), raster);
    return raster;
  };
}

}  // namespace

MapBox bounds_of(const BuiltMap& built) {
  MapBox all = built.days.front().map.bounds();
  for (const DayMap& day : built.days) {
    const MapBox box = day.map.bounds();
    const int i1 = std::max(all.i0 + all.columns, box.i0 + box.columns);
    const int j1 = std::max(all.j0 + all.rows, box.j0 + box.rows);
    all.i0 = std::min(all.i0, box.i0);
    all.j0 = std::min(all.j0, box.j0);
    all.columns = i1 - all.i0;
    all.rows = j1 - all.j0;
  }
  return all;
}

io::ReadMap newest_cells(const BuiltMap& built) {
  return newest(built, [](const RoadMap& map, const MapBox& box) { return map.read(box); });
}

io::ReadMap newest_relief(const BuiltMap& built) {
  return newest(built, [](const RoadMap& map, const MapBox& box) { return read_relief(map, box); });
}

}  // namespace roadstereo::cli
