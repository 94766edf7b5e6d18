#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "roadstereo/error.hpp"
#include "roadstereo/io/geo_files.hpp"

namespace {

using namespace roadstereo;
using namespace roadstereo::io;

TEST(WithoutGeo, ErrorNamesMissingPackages) {
  TrackOptions().validate();
  try {
    read_track("flight.gpx");
    FAIL() << "no error";
  } catch (const Error& error) {
    for (const char* package : {"libgdal-dev", "libgeographiclib-dev", "libpugixml-dev", "ROADSTEREO_GEO"}) {
      EXPECT_NE(std::string(error.what()).find(package), std::string::npos) << error.what();
    }
  }
  EXPECT_THROW(Track({{0, 0, 0}, {1, 0, 0}}), Error);
}

TEST(WithoutGeo, WritesFramesWithoutPosition) {
  const GeoFrame frame;
  const nlohmann::json document = nlohmann::json::parse(geojson_files({std::span(&frame, 1), {}, {}}).front().text);
  EXPECT_TRUE(document.at("features").at(0).at("geometry").is_null());
}

}  // namespace
