#include "map/map_files.hpp"

#include <system_error>
#include <utility>

#include "inspect_flight.hpp"
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

/// Reads a map block by block until Ctrl-C: its checkpoint has all of it.
io::ReadMap until_stopped(io::ReadMap read, const StopSignals& stop) {
  return [read = std::move(read), &stop](const MapBox& box) {
    if (stop.wait(0)) throw Interrupted{"interrupted; continue with --resume"};
    return read(box);
  };
}

}  // namespace

std::vector<std::string> write_rasters(const MapPlan& plan, const BuiltMap& built, const std::filesystem::path& folder,
                                       const StopSignals& stop) {
  const MapBox bounds = bounds_of(built);
  const io::MapReference reference = reference_of(plan, built);
  const io::ReadMap read = until_stopped(newest_cells(built), stop);
  std::vector<std::string> names;
  const auto file = [&](const char* name) {
    names.emplace_back(name);
    return folder / name;
  };
  io::write_geotiff(file("orthophoto.tif"), io::MapLayer::orthophoto, bounds, reference, read);
  io::write_geotiff(file("height.tif"), io::MapLayer::height, bounds, reference, read);
  io::write_geotiff(file("sigma.tif"), io::MapLayer::sigma, bounds, reference, read);
  io::write_geotiff(file("relief.tif"), io::MapLayer::relief, bounds, reference,
                    until_stopped(newest_relief(built), stop));
  io::write_geotiff(file("views.tif"), io::MapLayer::views, bounds, reference, read);
  if (plan.points) io::write_map_points(file(points_file), bounds, reference, read);
  if (plan.las) io::write_map_las(file(las_file), bounds, reference, read);
  return names;
}

std::vector<std::uint8_t> overview_of(const MapPlan& plan, const BuiltMap& built,
                                      std::span<const RoadDamageRecord> damages, const StopSignals& stop) {
  return io::map_picture(bounds_of(built), reference_of(plan, built), until_stopped(newest_cells(built), stop),
                         until_stopped(newest_relief(built), stop), damages);
}

void remove_map(const std::filesystem::path& folder) {
  std::error_code ignored;
  for (const char* name :
       {"orthophoto.tif", "height.tif", "sigma.tif", "relief.tif", "views.tif", points_file, las_file, "damages.csv",
        "sightings.csv", "transverse.csv", "longitudinal.csv", "roughness.csv", "changes.csv", "map.jpg", "map.json"}) {
    std::filesystem::remove(folder / name, ignored);
  }
  std::filesystem::remove(folder, ignored);  // only when empty
}

}  // namespace roadstereo::cli
