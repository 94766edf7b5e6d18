#include "roadstereo/io/map_points.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <vector>

#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

template <class Visit>
void for_each_block(const MapBox& bounds, const ReadMap& read, const Visit& visit) {
  constexpr int block = 512;
  for (int j = 0; j < bounds.rows; j += block) {
    for (int i = 0; i < bounds.columns; i += block) {
      visit(
          read({bounds.i0 + i, bounds.j0 + j, std::min(block, bounds.columns - i), std::min(block, bounds.rows - j)}));
    }
  }
}

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
  stream << "ply\nformat binary_little_endian 1.0\nelement vertex " << points
         << "\nproperty double x\nproperty double y\nproperty double z\nproperty float sigma\nproperty uchar red\n"
            "property uchar green\nproperty uchar blue\nend_header\n";
  std::vector<char> bytes;
  for_each_block(bounds, read, [&](const MapRaster& raster) {
    bytes.clear();
    const MapBox& box = raster.box;
    for (int v = 0; v < box.rows; ++v) {
      for (int u = 0; u < box.columns; ++u) {
        if (raster.views(u, v) == 0) continue;
        append(bytes, reference.east_m + (box.i0 + u + 0.5) * reference.cell_m);
        append(bytes, reference.north_m + (box.j0 + box.rows - v - 0.5) * reference.cell_m);
        append(bytes, reference.up_m + raster.height(u, v));
        append(bytes, raster.sigma(u, v));
        for (const std::uint8_t colour : raster.colour(u, v)) append(bytes, colour);
      }
    }
    stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  });
  stream.close();
  if (!stream) fail<SystemError>(file.string(), ": cannot be written");
}

}  // namespace roadstereo::io
