#include <bit>

#include "roadstereo/error.hpp"
#include "roadstereo/io/point_cloud.hpp"

namespace roadstereo::io {
namespace {

void append_float(float value, std::vector<std::uint8_t>& bytes) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  for (unsigned shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<std::uint8_t>(bits >> shift));
}

std::string ply_header(const PointCloud& cloud) {
  std::string header = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(cloud.points.size()) +
                       "\nproperty float x\nproperty float y\nproperty float z\n";
  if (!cloud.colours.empty()) header += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  return header + "end_header\n";
}

}  // namespace

std::vector<std::uint8_t> encode_ply(const PointCloud& cloud) {
  if (!cloud.colours.empty() && cloud.colours.size() != cloud.points.size()) {
    fail("the cloud has ", cloud.points.size(), " points and ", cloud.colours.size(), " colours");
  }
  const std::string header = ply_header(cloud);
  std::vector<std::uint8_t> bytes(header.begin(), header.end());
  constexpr std::size_t max_per_point = 3 * sizeof(float) + 3;
  bytes.reserve(bytes.size() + cloud.points.size() * max_per_point);
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    for (const float x : cloud.points[i]) append_float(x, bytes);
    if (!cloud.colours.empty()) bytes.insert(bytes.end(), cloud.colours[i].begin(), cloud.colours[i].end());
  }
  return bytes;
}

}  // namespace roadstereo::io
