// LAS 1.4 (ASPRS, revision R15), point data record format 7 with one extra number per point.

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include "io/geo/map_crs.hpp"
#include "io/map_blocks.hpp"
#include "io/require_written.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/io/map_points.hpp"
#include "roadstereo/version.hpp"

namespace roadstereo::io {
namespace {

constexpr double las_scale_m = 1e-4;  ///< of the stored integers
constexpr std::uint16_t las_header_bytes = 375, las_record_bytes = 36 + 4;

/// Little-endian fields, one after another.
class LasBytes {
 public:
  template <class Integer>
  LasBytes& number(Integer value) {
    auto bits = static_cast<std::uint64_t>(value);
    for (std::size_t i = 0; i < sizeof(Integer); ++i, bits >>= 8) bytes_.push_back(static_cast<char>(bits & 0xFF));
    return *this;
  }
  LasBytes& real(double value) { return number(std::bit_cast<std::uint64_t>(value)); }
  LasBytes& real(float value) { return number(std::bit_cast<std::uint32_t>(value)); }
  LasBytes& zeros(std::size_t count) {
    bytes_.append(count, '\0');
    return *this;
  }
  /// Text, filled up with zeros.
  LasBytes& text(const std::string& words, std::size_t size) {
    bytes_ += words.substr(0, size);
    return zeros(size - std::min(size, words.size()));
  }
  const std::string& bytes() const { return bytes_; }
  void clear() { bytes_.clear(); }

 private:
  std::string bytes_;
};

/// Number and bounds of the points.
struct LasExtent {
  std::uint64_t points = 0;
  std::array<std::int32_t, 3> low{std::numeric_limits<std::int32_t>::max(), std::numeric_limits<std::int32_t>::max(),
                                  std::numeric_limits<std::int32_t>::max()};
  std::array<std::int32_t, 3> high{std::numeric_limits<std::int32_t>::min(), std::numeric_limits<std::int32_t>::min(),
                                   std::numeric_limits<std::int32_t>::min()};

  void add(const std::array<std::int32_t, 3>& at) {
    ++points;
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], at[k]);
      high[k] = std::max(high[k], at[k]);
    }
  }
};

void add_vlr_header(LasBytes& out, const char* user, std::uint16_t record, std::size_t size, const char* description) {
  out.number(std::uint16_t{0}).text(user, 16).number(record).number(static_cast<std::uint16_t>(size));
  out.text(description, 32);
}

/// Variable length records: the coordinate system, and what the extra number is.
std::string las_records(const MapReference& reference) {
  constexpr std::uint16_t wkt_record = 2112, extra_bytes_record = 4;
  constexpr std::size_t descriptor_bytes = 192;
  constexpr std::uint8_t float_type = 9;
  const std::string wkt = map_wkt(reference);
  LasBytes out;
  add_vlr_header(out, "LASF_Projection", wkt_record, wkt.size() + 1, "OGC WKT 1");
  out.text(wkt, wkt.size() + 1);
  add_vlr_header(out, "LASF_Spec", extra_bytes_record, descriptor_bytes, "extra bytes");
  out.zeros(2).number(float_type).zeros(1).text("sigma", 32).zeros(124).text("standard error of z, m", 32);
  return out.bytes();
}

std::string las_header(std::size_t record_bytes, const std::array<double, 3>& offset_m, const LasExtent& extent) {
  constexpr std::uint16_t wkt_bit = 1U << 4U;
  constexpr std::uint8_t format = 7;
  LasBytes out;
  out.text("LASF", 4).number(std::uint16_t{0}).number(wkt_bit).zeros(16);
  out.number(std::uint8_t{1}).number(std::uint8_t{4}).text("OTHER", 32).text(std::string("roadstereo ") + version, 32);
  out.zeros(4);  // date: equal maps are equal files
  out.number(las_header_bytes).number(static_cast<std::uint32_t>(las_header_bytes + record_bytes));
  out.number(std::uint32_t{2}).number(format).number(las_record_bytes).zeros(4 + 5 * 4);  // no legacy counts
  for (int k = 0; k < 3; ++k) out.real(las_scale_m);
  for (const double offset : offset_m) out.real(offset);
  for (std::size_t k = 0; k < 3; ++k) {
    for (const std::int32_t bound : {extent.high[k], extent.low[k]}) out.real(bound * las_scale_m + offset_m[k]);
  }
  out.zeros(8 + 8 + 4).number(extent.points).number(extent.points).zeros(std::size_t{14} * 8);  // all are first returns
  return out.bytes();
}

std::int32_t las_integer(double value_m, double offset_m) {
  const double steps = std::round((value_m - offset_m) / las_scale_m);
  if (std::abs(steps) >= std::numeric_limits<std::int32_t>::max()) {
    fail("a point of the map is ", std::abs(value_m - offset_m), " m from its origin; LAS takes at most 214 km");
  }
  return static_cast<std::int32_t>(steps);
}

void add_las_point(LasBytes& out, const std::array<std::int32_t, 3>& at, const MapRaster& raster, int u, int v) {
  constexpr std::uint8_t one_of_one = 0x11, road_surface = 11;
  for (const std::int32_t coordinate : at) out.number(coordinate);
  out.zeros(2).number(one_of_one).zeros(1).number(road_surface).zeros(1 + 2 + 2 + 8);
  for (const std::uint8_t colour : raster.colour(u, v)) out.number(static_cast<std::uint16_t>(257 * colour));
  out.real(raster.sigma(u, v));
}

}  // namespace

void write_map_las(const std::filesystem::path& file, const MapBox& bounds, const MapReference& reference,
                   const ReadMap& read) {
  const std::string records = las_records(reference);
  const std::array<double, 3> offset_m{std::floor(reference.east_m + bounds.i0 * reference.cell_m),
                                       std::floor(reference.north_m + bounds.j0 * reference.cell_m),
                                       std::floor(reference.up_m)};
  std::ofstream stream(file, std::ios::binary);
  require_written(stream, file);
  stream << std::string(las_header_bytes, '\0') << records;
  LasExtent extent;
  LasBytes block;
  for_each_block(bounds, read, [&](const MapRaster& raster) {
    block.clear();
    for_each_point(raster, reference, [&](double x, double y, double z, int u, int v) {
      const std::array<std::int32_t, 3> at{las_integer(x, offset_m[0]), las_integer(y, offset_m[1]),
                                           las_integer(z, offset_m[2])};
      extent.add(at);
      add_las_point(block, at, raster, u, v);
    });
    stream << block.bytes();
    require_written(stream, file);
  });
  if (extent.points == 0) fail(file.string(), ": the map is empty");
  stream.seekp(0);
  stream << las_header(records.size(), offset_m, extent);
  stream.close();
  require_written(stream, file);
}

}  // namespace roadstereo::io
