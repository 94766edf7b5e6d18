// Replacement for builds without GDAL, GeographicLib and pugixml.

#include <utility>

#include "roadstereo/error.hpp"
#include "roadstereo/io/geo_files.hpp"
#include "roadstereo/io/local_axes.hpp"

namespace roadstereo::io {
namespace {

[[noreturn]] void fail_without_geo() {
  fail("this build does not support tracks; it needs the packages libgdal-dev, libgeographiclib-dev ",
       "(libgeographic-dev on Ubuntu 22.04) and libpugixml-dev, and CMake's -DROADSTEREO_GEO=ON");
}

}  // namespace

Track::Track(std::vector<TrackPoint> points, const TrackOptions& options)
    : points_(std::move(points)), options_(options) {
  fail_without_geo();
}

Track read_track(const std::string& /*path*/, const TrackOptions& /*options*/) {
  fail_without_geo();
}

std::optional<GeoPosition> position_at(const Track& /*track*/, double /*time_s*/) {
  fail_without_geo();
}

std::optional<GeoPosition> offset_position(const GeoPosition& /*from*/, double /*right_m*/, double /*forward_m*/,
                                           double /*up_m*/) {
  fail_without_geo();
}

double distance_m(const GeoPosition& /*from*/, const GeoPosition& /*to*/) {
  fail_without_geo();
}

LocalAxes::LocalAxes(const Track& /*track*/, double /*from_s*/, double /*to_s*/) {
  fail_without_geo();
}

std::array<double, 12> LocalAxes::to_utm(const std::array<double, 12>& /*pose*/) const {
  fail_without_geo();
}

GeoPosition LocalAxes::position(const std::array<double, 12>& /*pose*/) const {
  fail_without_geo();
}

std::vector<std::uint8_t> geopackage(const GeoLayers& /*layers*/, const Track& /*track*/) {
  fail_without_geo();
}

}  // namespace roadstereo::io
