#include "map/map_files.hpp"

#include "roadstereo/io/geotiff.hpp"
#include "roadstereo/io/map_points.hpp"
#include "roadstereo/road_relief.hpp"

namespace roadstereo::cli {

void write_rasters(const MapSettings& settings, const BuiltMap& built, const std::filesystem::path& folder) {
  const RoadMap& map = *built.map;
  const MapBox bounds = map.bounds();
  const io::MapReference reference{map.options().cell_m, built.origin_m[0], built.origin_m[1], built.origin_m[2],
                                   settings.crs};
  const io::ReadMap read = [&](const MapBox& box) { return map.read(box); };
  io::write_geotiff(folder / "orthophoto.tif", io::MapLayer::orthophoto, bounds, reference, read);
  io::write_geotiff(folder / "height.tif", io::MapLayer::height, bounds, reference, read);
  io::write_geotiff(folder / "sigma.tif", io::MapLayer::sigma, bounds, reference, read);
  io::write_geotiff(folder / "relief.tif", io::MapLayer::relief, bounds, reference,
                    [&](const MapBox& box) { return read_relief(map, box); });
  io::write_geotiff(folder / "views.tif", io::MapLayer::views, bounds, reference, read);
  if (settings.points) io::write_map_points(folder / "points.ply", bounds, reference, read);
}

}  // namespace roadstereo::cli
