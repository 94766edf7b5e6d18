#include "map/map_files.hpp"

#include "map/day_layers.hpp"
#include "roadstereo/io/geotiff.hpp"
#include "roadstereo/io/map_picture.hpp"
#include "roadstereo/io/map_points.hpp"

namespace roadstereo::cli {
namespace {

io::MapReference reference_of(const MapPlan& plan, const BuiltMap& built) {
  const double cell_m = built.days.back().map.options().cell_m;
  return {cell_m, built.origin_m[0], built.origin_m[1], built.origin_m[2], plan.crs};
}

}  // namespace

void write_rasters(const MapPlan& plan, const BuiltMap& built, const std::filesystem::path& folder) {
  const MapBox bounds = bounds_of(built);
  const io::MapReference reference = reference_of(plan, built);
  const io::ReadMap read = newest_cells(built);
  io::write_geotiff(folder / "orthophoto.tif", io::MapLayer::orthophoto, bounds, reference, read);
  io::write_geotiff(folder / "height.tif", io::MapLayer::height, bounds, reference, read);
  io::write_geotiff(folder / "sigma.tif", io::MapLayer::sigma, bounds, reference, read);
  io::write_geotiff(folder / "relief.tif", io::MapLayer::relief, bounds, reference, newest_relief(built));
  io::write_geotiff(folder / "views.tif", io::MapLayer::views, bounds, reference, read);
  if (plan.points) io::write_map_points(folder / "points.ply", bounds, reference, read);
  if (plan.las) io::write_map_las(folder / "points.las", bounds, reference, read);
}

std::vector<std::uint8_t> overview_of(const MapPlan& plan, const BuiltMap& built,
                                      std::span<const RoadDamageRecord> damages) {
  return io::map_picture(bounds_of(built), reference_of(plan, built), newest_cells(built), newest_relief(built),
                         damages);
}

}  // namespace roadstereo::cli
