#include "roadstereo/io/map_points.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <string>
#include <vector>

#include "io/map_blocks.hpp"
#include "io/require_written.hpp"

namespace roadstereo::io {
namespace {

template <class Value>
void append(std::vector<char>& bytes, Value value) {
  const std::size_t size = bytes.size();
  bytes.resize(size + sizeof value);
  std::memcpy(bytes.data() + size, &value, sizeof value);
}

}  // namespace

void write_map_points(const std::filesystem::path& file, const MapBox& bounds, const MapReference& reference,
                      const ReadMap& read) {
  std::size_t points = 0;
  for_each_block(bounds, read, [&](const MapRaster& raster) {
    const std::uint16_t* const views = raster.views.row(0);
    points += raster.views.pixels() - static_cast<std::size_t>(std::count(views, views + raster.views.pixels(), 0));
  });
  std::ofstream stream(file, std::ios::binary);
  require_written(stream, file);
  stream << "ply\nformat binary_little_endian 1.0\nelement vertex " << std::to_string(points)
         << "\nproperty double x\nproperty double y\nproperty double z\nproperty float sigma\nproperty uchar red\n"
            "property uchar green\nproperty uchar blue\nend_header\n";
  std::vector<char> bytes;
  for_each_block(bounds, read, [&](const MapRaster& raster) {
    bytes.clear();
    for_each_point(raster, reference, [&](double x, double y, double z, int u, int v) {
      for (const double coordinate : {x, y, z}) append(bytes, coordinate);
      append(bytes, raster.sigma(u, v));
      for (const std::uint8_t colour : raster.colour(u, v)) append(bytes, colour);
    });
    stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    require_written(stream, file);
  });
  stream.close();
  require_written(stream, file);
}

}  // namespace roadstereo::io
