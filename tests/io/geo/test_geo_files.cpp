#include <gtest/gtest.h>
#include <ogrsf_frmts.h>
#include <stdlib.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>
#include <regex>
#include <set>

#include "io/damage_columns.hpp"
#include "io/geo/gdal_errors.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/io/geo_files.hpp"

namespace {

namespace fs = std::filesystem;
using namespace roadstereo;
using namespace roadstereo::io;
using Json = nlohmann::json;

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
constexpr double noon = 1714564800;  // date -u -d 2024-05-01T12:00:00Z +%s

// Of a degree, at the equator of WGS84: π/180 times 6378137·(1 − e²) and 6378137.
constexpr double metres_of_latitude = 110574.2758;
constexpr double metres_of_longitude = 111319.4908;

/// One placed frame of which all is known, one of which nothing is.
std::vector<GeoFrame> two_frames() {
  GeoFrame known;
  known.index = 7;
  known.name = "strasse \"ä\".png";
  known.time_s = noon + 59.9996;  // to the millisecond: the next minute
  known.position = GeoPosition{50.123456789, -8.00000001, 123.4567, 271.5};
  known.roll_rad = 0.1;
  known.height_m = 4.25;
  known.sigma_d_px = 0.5;
  known.valid_share = 0.875;
  known.damages = 2;
  known.status = "ok";
  GeoFrame lost;
  lost.index = 8;
  lost.name = "b";
  lost.status = "rejected: unpaired";
  known.station_m = 4.5;
  known.footprint_deg = {{-8, 50}, {-7.99, 50}, {-7.99, 50.01}, {-8, 50.01}};
  return {known, lost};
}

Damage metric_damage() {
  Damage damage;
  damage.id = 3;
  damage.kind = DamageKind::depression;
  damage.pixels = 1234;
  damage.cut_by_border = true;
  DamageMetrics& metrics = damage.metrics.emplace();
  metrics.max_depth_m = {0.0321, 0.0015};
  metrics.area_m2 = {0.25, 0.01};
  metrics.diameter_m = unknown;
  metrics.distress = Distress::pothole;
  metrics.quantity = 1;
  metrics.severity = Severity::medium;
  return damage;
}

/// One placed damage in metres, one of an uncalibrated frame.
std::vector<GeoSighting> two_sightings() {
  GeoSighting metric{5, 7, "a", noon, metric_damage(), GeoPosition{-33.5, 179.9999999999, unknown, 0}};
  GeoSighting plain;
  plain.frame = 8;
  plain.damage.id = 3;  // ids count within a frame
  plain.damage.kind = DamageKind::protrusion;
  return {metric, plain};
}

/// A damage with an outline of 2 m × 1 m seen in four frames, a candidate, and a damage without a position.
std::vector<RoadDamage> three_damages() {
  RoadDamage placed;
  placed.id = 5;
  placed.sightings = 4;
  placed.first_frame = 6;
  placed.last_frame = 9;
  placed.frame = 7;
  placed.frame_name = "a";
  placed.time_s = noon;
  placed.best = metric_damage();
  placed.best.confidence = 0.875;
  placed.position = GeoPosition{0, 8, 100, 0};
  const double lon = 1 / metres_of_longitude, lat = 0.5 / metres_of_latitude;
  placed.outline_deg = {{8 - lon, -lat}, {8 + lon, -lat}, {8 + lon, lat}, {8 - lon, lat}};
  placed.station_m = 12.5;
  placed.picture = "damages/00005.jpg";
  RoadDamage candidate = placed;
  candidate.id = 6;
  candidate.candidate = true;
  candidate.picture.clear();
  RoadDamage lost;
  lost.id = 9;
  lost.best.kind = DamageKind::protrusion;
  return {placed, candidate, lost};
}

const std::vector<GeoFrame>& frames() {
  static const std::vector<GeoFrame> all = two_frames();
  return all;
}

GeoLayers layers(bool with_candidates = false) {
  static const std::vector<GeoSighting> sightings = two_sightings();
  static const std::vector<RoadDamage> damages = three_damages();
  return {frames(), sightings, damages, with_candidates};
}

/// The text of one GeoJSON file.
std::string geojson(const std::string& name, const GeoLayers& rows) {
  for (const NamedText& file : geojson_files(rows)) {
    if (file.name == name) return file.text;
  }
  return "";
}

std::string frames_geojson(std::span<const GeoFrame> rows) {
  return geojson("frames.geojson", {rows, {}, {}});
}

/// A metre a second northwards, a gap, then a metre a second across the antimeridian.
Track broken_track() {
  constexpr double metre_deg = 1 / metres_of_latitude;
  return Track({{noon, 0, 179.9375},
                {noon + 1, metre_deg, 179.9375},
                {noon + 2, 2 * metre_deg, 179.9375},
                {noon + 100, 0, 180 - 3 * metre_deg},
                {noon + 101, 0, 180 - 2 * metre_deg},
                {noon + 102, 0, -180 + 2 * metre_deg},
                {noon + 103, 0, -180 + 3 * metre_deg}});
}

void expect_rfc7946_point(const Json& geometry) {
  EXPECT_EQ(geometry.at("type"), "Point");
  const Json& position = geometry.at("coordinates");
  ASSERT_TRUE(position.is_array() && (position.size() == 2 || position.size() == 3)) << position;
  for (const Json& number : position) EXPECT_TRUE(number.is_number()) << position;
  EXPECT_LE(std::abs(position[0].get<double>()), 180);
  EXPECT_LE(std::abs(position[1].get<double>()), 90);
}

/// Section 3 of RFC 7946, of a collection of points; section 4: no other coordinate reference system.
void expect_rfc7946(const std::string& text, std::size_t count) {
  const Json document = Json::parse(text);
  EXPECT_EQ(document.at("type"), "FeatureCollection");
  EXPECT_FALSE(document.contains("crs"));
  ASSERT_EQ(document.at("features").size(), count);
  std::set<int> ids;
  for (const Json& feature : document.at("features")) {
    EXPECT_EQ(feature.at("type"), "Feature");
    ids.insert(feature.at("id").get<int>());
    EXPECT_TRUE(feature.at("properties").is_object());
    ASSERT_TRUE(feature.contains("geometry"));
    if (!feature.at("geometry").is_null()) expect_rfc7946_point(feature.at("geometry"));
  }
  EXPECT_EQ(ids.size(), count);
}

TEST(GeoJson, WritesFrames) {
  const std::string text = frames_geojson(two_frames());
  expect_rfc7946(text, 2);
  const Json document = Json::parse(text);
  const Json& known = document.at("features")[0];
  EXPECT_EQ(known.at("geometry").at("coordinates"), Json({-8.0, 50.1234568, 123.457}));
  EXPECT_EQ(known.at("properties"),
            Json::parse(R"({"frame": 7, "name": "strasse \"ä\".png", "time_utc": "2024-05-01T12:01:00.000Z",
                            "time_s": 1714564859.9996, "status": "ok", "damages": 2, "station_m": 4.5, "heading_deg": 271.5,
                            "alt_m": 123.4567, "roll_deg": 5.729577951308232, "height_m": 4.25, "sigma_d_px": 0.5,
                            "valid_share": 0.875})"));
  const Json& lost = document.at("features")[1];
  EXPECT_TRUE(lost.at("geometry").is_null());
  EXPECT_EQ(lost.at("properties").size(), known.at("properties").size());
  for (const char* name : {"time_utc", "time_s", "heading_deg", "alt_m", "roll_deg", "height_m", "valid_share"}) {
    EXPECT_TRUE(lost.at("properties").at(name).is_null()) << name;
  }
}

TEST(GeoJson, WritesSightings) {
  const std::string text = geojson("sightings.geojson", layers());
  expect_rfc7946(text, 2);
  const Json document = Json::parse(text);
  const Json& metric = document.at("features")[0];
  EXPECT_EQ(metric.at("geometry").at("coordinates"), Json({180.0, -33.5}));
  const Json& properties = metric.at("properties");
  EXPECT_EQ(properties.at("road_damage"), 5);
  EXPECT_EQ(properties.at("frame"), 7);
  EXPECT_EQ(properties.at("time_utc"), "2024-05-01T12:00:00.000Z");
  EXPECT_EQ(properties.at("id"), 3);
  EXPECT_EQ(properties.at("distress"), "pothole");
  EXPECT_EQ(properties.at("severity"), "medium");
  EXPECT_EQ(properties.at("max_depth_m"), 0.0321);
  EXPECT_EQ(properties.at("max_depth_m_stderr"), 0.0015);
  EXPECT_EQ(properties.at("cut_by_border"), true);
  EXPECT_TRUE(properties.at("diameter_m").is_null());
  for (const DamageColumn& column : damage_columns()) EXPECT_TRUE(properties.contains(column.name)) << column.name;
  EXPECT_TRUE(document.at("features")[1].at("geometry").is_null());
  EXPECT_TRUE(document.at("features")[1].at("properties").at("area_m2").is_null());
}

/// RFC 7946, 3.1.6: the ring is closed and counterclockwise, its signed area positive.
TEST(GeoJson, DamageIsOneClosedPolygon) {
  const Json document = Json::parse(geojson("damages.geojson", layers()));
  ASSERT_EQ(document.at("features").size(), 2U) << "without the candidate";
  const Json& ring = document.at("features")[0].at("geometry").at("coordinates")[0];
  ASSERT_EQ(ring.size(), 5U);
  EXPECT_EQ(ring[0], ring[4]);
  double area_m2 = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto cross = ring[i][0].get<double>() * ring[i + 1][1].get<double>() -
                       ring[i + 1][0].get<double>() * ring[i][1].get<double>();
    area_m2 += 0.5 * cross * metres_of_longitude * metres_of_latitude;
  }
  EXPECT_NEAR(area_m2, 2, 1e-3);
  const Json& properties = document.at("features")[0].at("properties");
  EXPECT_EQ(properties.at("sightings"), 4);
  EXPECT_EQ(properties.at("first_frame"), 6);
  EXPECT_EQ(properties.at("last_frame"), 9);
  EXPECT_EQ(properties.at("picture"), "damages/00005.jpg");
  EXPECT_EQ(properties.at("station_m"), 12.5);
  EXPECT_TRUE(document.at("features")[1].at("geometry").is_null());
  EXPECT_EQ(geojson("candidates.geojson", layers()), "") << "not asked for";
  expect_rfc7946(geojson("footprints.geojson", {{}, {}, {}}), 0);
  const Json candidates = Json::parse(geojson("candidates.geojson", layers(true)));
  ASSERT_EQ(candidates.at("features").size(), 1U);
  EXPECT_EQ(candidates.at("features")[0].at("properties").at("id"), 6);
}

TEST(GeoJson, FootprintIsPolygon) {
  const Json document = Json::parse(geojson("footprints.geojson", layers()));
  EXPECT_EQ(document.at("features")[0].at("geometry"), Json::parse(R"({"type": "Polygon", "coordinates":
                            [[[-8.0, 50.0], [-7.99, 50.0], [-7.99, 50.01], [-8.0, 50.01], [-8.0, 50.0]]]})"));
  EXPECT_TRUE(document.at("features")[1].at("geometry").is_null());
}

TEST(GeoJson, NoFramesGiveEmptyCollection) {
  for (const NamedText& file : geojson_files({})) expect_rfc7946(file.text, 0);
}

TEST(RoadDamagesCsv, HasPlaceAndElevenColumns) {
  EXPECT_EQ(road_damages_csv_names(),
            "id,lat_deg,lon_deg,distress,severity,max_depth_m,max_depth_m_stderr,area_m2,area_m2_stderr,quantity,unit,"
            "confidence,cut_by_border,picture\r\n");
  EXPECT_EQ(road_damages_csv_rows(std::span(layers().damages).first(1)),
            "5,0,8,pothole,medium,0.0321,0.0015,0.25,0.01,1,count,0.875,true,damages/00005.jpg\r\n");
  EXPECT_EQ(road_damages_csv_rows(std::span(layers().damages).last(1)), "9,,,unknown,unknown,,,,,,,0,false,\r\n");
}

TEST(GeoJson, PositionsHaveSevenDecimals) {
  GeoFrame frame;
  for (const double lat_deg : {1.0 / 3, -1e-9, -89.99999999, 12.00000005}) {
    frame.position = GeoPosition{lat_deg, lat_deg, unknown, 0};
    const std::string text = frames_geojson(std::span(&frame, 1));
    EXPECT_FALSE(std::regex_search(text, std::regex(R"(coordinates":\[[^\]]*\.\d{8})"))) << text;
    EXPECT_FALSE(std::regex_search(text, std::regex(R"(-0\.0[,\]])"))) << text;
    const Json document = Json::parse(text);
    EXPECT_NEAR(document.at("features")[0].at("geometry").at("coordinates")[1].get<double>(), lat_deg, 0.51e-7);
  }
}

TEST(GeoJson, RelativeTimesHaveNoDate) {
  GeoFrame frame;
  frame.time_s = 12.5;
  const Json document = Json::parse(frames_geojson(std::span(&frame, 1)));
  EXPECT_TRUE(document.at("features")[0].at("properties").at("time_utc").is_null());
  EXPECT_EQ(document.at("features")[0].at("properties").at("time_s"), 12.5);
}

TEST(GeoJson, NamesThatAreNotUtf8StayValid) {
  GeoFrame frame;
  frame.name = "\xe4.png";
  expect_rfc7946(frames_geojson(std::span(&frame, 1)), 1);
}

/// A file of its own, opened by GDAL.
class GeoFile : public testing::Test {
 protected:
  GeoFile() {
    std::string name = (fs::temp_directory_path() / "roadstereo-geo-XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
  }
  ~GeoFile() override {
    dataset_.reset();
    fs::remove_all(folder_);
  }

  std::string write(const std::string& name, const std::string& text) const {
    const fs::path path = folder_ / name;
    std::ofstream(path, std::ios::binary) << text;
    return path.string();
  }
  std::string write_flight() const {
    const std::vector<std::uint8_t> bytes = geopackage(layers(), broken_track());
    return write("flight.gpkg", std::string(bytes.begin(), bytes.end()));
  }
  GDALDataset& open(const std::string& path) {
    GDALAllRegister();
    dataset_.reset(GDALDataset::Open(path.c_str(), GDAL_OF_VECTOR | GDAL_OF_VERBOSE_ERROR));
    if (dataset_ == nullptr) throw std::runtime_error("GDAL does not open " + path);
    return *dataset_;
  }

 private:
  fs::path folder_;
  GDALDatasetUniquePtr dataset_;
};

using GeoPackage = GeoFile;

void expect_wgs84(OGRLayer& layer) {
  const OGRSpatialReference* reference = layer.GetSpatialRef();
  ASSERT_NE(reference, nullptr);
  EXPECT_STREQ(reference->GetAuthorityName(nullptr), "EPSG");
  EXPECT_STREQ(reference->GetAuthorityCode(nullptr), "4326");
}

OGRFieldType type_of(OGRLayer& layer, const char* field) {
  return layer.GetLayerDefn()->GetFieldDefn(layer.GetLayerDefn()->GetFieldIndex(field))->GetType();
}

TEST_F(GeoPackage, WritesFrames) {
  OGRLayer* layer = open(write_flight()).GetLayerByName("frames");
  ASSERT_NE(layer, nullptr);
  expect_wgs84(*layer);
  ASSERT_EQ(layer->GetFeatureCount(), 2);
  EXPECT_EQ(type_of(*layer, "frame"), OFTInteger64);
  EXPECT_EQ(type_of(*layer, "time_utc"), OFTDateTime);
  EXPECT_EQ(type_of(*layer, "sigma_d_px"), OFTReal);
  const OGRFeatureUniquePtr known(layer->GetNextFeature());
  const OGRPoint* point = known->GetGeometryRef()->toPoint();
  EXPECT_DOUBLE_EQ(point->getX(), -8.00000001);
  EXPECT_DOUBLE_EQ(point->getY(), 50.123456789);
  EXPECT_STREQ(known->GetFieldAsString("name"), "strasse \"ä\".png");
  EXPECT_STREQ(known->GetFieldAsString("time_utc"), "2024/05/01 12:01:00+00");
  EXPECT_DOUBLE_EQ(known->GetFieldAsDouble("height_m"), 4.25);
  EXPECT_EQ(known->GetFieldAsInteger("damages"), 2);
  const OGRFeatureUniquePtr lost(layer->GetNextFeature());
  EXPECT_EQ(lost->GetGeometryRef(), nullptr);
  EXPECT_TRUE(lost->IsFieldNull(lost->GetFieldIndex("time_utc")));
  EXPECT_TRUE(lost->IsFieldNull(lost->GetFieldIndex("height_m")));
  EXPECT_STREQ(lost->GetFieldAsString("status"), "rejected: unpaired");
}

TEST_F(GeoPackage, WritesSightings) {
  OGRLayer* layer = open(write_flight()).GetLayerByName("sightings");
  ASSERT_NE(layer, nullptr);
  expect_wgs84(*layer);
  ASSERT_EQ(layer->GetFeatureCount(), 2);
  EXPECT_EQ(type_of(*layer, "max_depth_m"), OFTReal);
  EXPECT_EQ(type_of(*layer, "pixels"), OFTInteger64);
  EXPECT_EQ(type_of(*layer, "kind"), OFTString);
  EXPECT_EQ(layer->GetLayerDefn()->GetFieldCount(), static_cast<int>(damage_columns().size()) + 4);
  const OGRFeatureUniquePtr metric(layer->GetNextFeature());
  EXPECT_EQ(metric->GetFieldAsInteger64("road_damage"), 5);
  EXPECT_EQ(metric->GetFieldAsInteger64("frame"), 7);
  EXPECT_EQ(metric->GetFieldAsInteger64("id"), 3);
  EXPECT_DOUBLE_EQ(metric->GetFieldAsDouble("max_depth_m"), 0.0321);
  EXPECT_STREQ(metric->GetFieldAsString("severity"), "medium");
  EXPECT_EQ(metric->GetFieldAsInteger("cut_by_border"), 1);
  EXPECT_TRUE(metric->IsFieldNull(metric->GetFieldIndex("diameter_m")));
  EXPECT_DOUBLE_EQ(metric->GetGeometryRef()->toPoint()->getY(), -33.5);
  const OGRFeatureUniquePtr plain(layer->GetNextFeature());
  EXPECT_STREQ(plain->GetFieldAsString("kind"), "protrusion");
  EXPECT_TRUE(plain->IsFieldNull(plain->GetFieldIndex("area_m2")));
  EXPECT_EQ(plain->GetFieldAsInteger("cut_by_border"), 0);
}

TEST_F(GeoPackage, DamageOfFourFramesIsOnePolygon) {
  OGRLayer* layer = open(write_flight()).GetLayerByName("damages");
  ASSERT_NE(layer, nullptr);
  expect_wgs84(*layer);
  ASSERT_EQ(layer->GetFeatureCount(), 2) << "without the candidate";
  const OGRFeatureUniquePtr placed(layer->GetNextFeature());
  const OGRPolygon* const area = placed->GetGeometryRef()->toPolygon();
  EXPECT_NEAR(area->get_Area() * metres_of_longitude * metres_of_latitude, 2, 1e-3);
  EXPECT_EQ(placed->GetFieldAsInteger64("id"), 5);
  EXPECT_EQ(placed->GetFieldAsInteger64("sightings"), 4);
  EXPECT_STREQ(placed->GetFieldAsString("distress"), "pothole");
  EXPECT_STREQ(placed->GetFieldAsString("picture"), "damages/00005.jpg");
  EXPECT_DOUBLE_EQ(placed->GetFieldAsDouble("lon_deg"), 8);
  EXPECT_EQ(open(write_flight()).GetLayerByName("candidates"), nullptr);
}

/// What QGIS asks for when it opens a layer: the default style of the table by its name.
TEST_F(GeoPackage, QgisFindsStyleBySeverity) {
  const std::vector<std::uint8_t> bytes = geopackage(layers(true), broken_track());
  GDALDataset& dataset = open(write("style.gpkg", std::string(bytes.begin(), bytes.end())));
  EXPECT_EQ(dataset.GetLayerByName("candidates")->GetFeatureCount(), 1);
  OGRLayer* styles = dataset.ExecuteSQL(
      "SELECT f_geometry_column, styleQML FROM layer_styles WHERE f_table_name = 'damages' AND useAsDefault = 1",
      nullptr, nullptr);
  ASSERT_NE(styles, nullptr);
  ASSERT_EQ(styles->GetFeatureCount(), 1);
  const OGRFeatureUniquePtr style(styles->GetNextFeature());
  EXPECT_STREQ(style->GetFieldAsString(0), dataset.GetLayerByName("damages")->GetGeometryColumn());
  pugi::xml_document qml;
  ASSERT_TRUE(qml.load_string(style->GetFieldAsString(1)));
  const pugi::xml_node renderer = qml.child("qgis").child("renderer-v2");
  EXPECT_STREQ(renderer.attribute("attr").value(), "severity");
  int categories = 0;
  for (const pugi::xml_node category : renderer.child("categories")) {
    const char* symbol = category.attribute("symbol").value();
    EXPECT_TRUE(renderer.child("symbols").find_child_by_attribute("symbol", "name", symbol)) << symbol;
    ++categories;
  }
  EXPECT_EQ(categories, 7);
  dataset.ReleaseResultSet(styles);
}

TEST_F(GeoPackage, TrackHasLinePerStretch) {
  OGRLayer* layer = open(write_flight()).GetLayerByName("track");
  ASSERT_NE(layer, nullptr);
  expect_wgs84(*layer);
  const std::array<int, 3> points = {3, 2, 2};
  const std::array<double, 3> lengths_m = {2, metres_of_longitude / metres_of_latitude,
                                           metres_of_longitude / metres_of_latitude};
  const std::array<const char*, 3> ends = {"2024/05/01 12:00:02+00", "2024/05/01 12:01:41+00",
                                           "2024/05/01 12:01:43+00"};
  ASSERT_EQ(layer->GetFeatureCount(), 3);
  for (std::size_t i = 0; i < 3; ++i) {
    const OGRFeatureUniquePtr line(layer->GetNextFeature());
    EXPECT_EQ(line->GetGeometryRef()->toLineString()->getNumPoints(), points.at(i));
    EXPECT_EQ(line->GetFieldAsInteger("points"), points.at(i));
    EXPECT_NEAR(line->GetFieldAsDouble("length_m"), lengths_m.at(i), 1e-6);
    EXPECT_STREQ(line->GetFieldAsString("end_utc"), ends.at(i));
  }
}

TEST_F(GeoPackage, NoFramesGiveEmptyLayers) {
  const std::vector<std::uint8_t> bytes = geopackage({}, broken_track());
  GDALDataset& dataset = open(write("empty.gpkg", std::string(bytes.begin(), bytes.end())));
  EXPECT_EQ(dataset.GetLayerCount(), 6);
  EXPECT_EQ(dataset.GetLayerByName("frames")->GetFeatureCount(), 0);
}

TEST_F(GeoPackage, ReleasesMemoryFile) {
  write_flight();
  char** left = VSIReadDir("/vsimem/");
  EXPECT_EQ(left, nullptr) << left[0];
  CSLDestroy(left);
}

TEST(GdalErrors, BecomeErrors) {
  testing::internal::CaptureStderr();
  {
    const GdalErrors errors;
    CPLError(CE_Warning, CPLE_AppDefined, "only a warning");
    errors.require(true, "something");
    CPLError(CE_Failure, CPLE_AppDefined, "no %s left", "room");
    try {
      errors.require(true, "writing");
      ADD_FAILURE() << "no error";
    } catch (const SystemError& error) {
      EXPECT_STREQ(error.what(), "cannot write the GeoPackage: writing failed: no room left");
    }
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

/// What a program prints; its exit status must be 0.
std::string output_of(const std::string& command) {
  std::FILE* pipe = ::popen((command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) throw std::runtime_error("cannot start " + command);
  std::string text;
  std::array<char, 4096> part{};
  for (std::size_t read = 0; (read = std::fread(part.data(), 1, part.size(), pipe)) > 0;)
    text.append(part.data(), read);
  EXPECT_EQ(::pclose(pipe), 0) << text;
  return text;
}

TEST_F(GeoFile, DamagesOfEqualIdAreTwoFeatures) {
  OGRLayer* layer = open(write("sightings.geojson", geojson("sightings.geojson", layers()))).GetLayer(0);
  for (const GIntBig row : {1, 2}) {
    const OGRFeatureUniquePtr feature(layer->GetFeature(row));
    ASSERT_NE(feature, nullptr) << row;
    EXPECT_EQ(feature->GetFieldAsInteger64("id"), 3);
    EXPECT_EQ(feature->GetFieldAsInteger64("frame"), 6 + row);
  }
}

class Ogrinfo : public GeoFile {
 protected:
  void SetUp() override {
    if (ogrinfo_.empty()) GTEST_SKIP() << "ogrinfo (gdal-bin) was not there when this was configured: not tested";
  }
  /// Expects every part in what ogrinfo says of a file, and no complaint.
  void expect_shown(const std::string& path, const std::vector<std::string>& parts) const {
    const std::string shown = output_of(ogrinfo_ + " -ro -al '" + path + "'");
    for (const std::string& part : parts) EXPECT_NE(shown.find(part), std::string::npos) << part << " in\n" << shown;
    for (const char* complaint : {"ERROR", "Warning"}) EXPECT_EQ(shown.find(complaint), std::string::npos) << shown;
  }

 private:
  std::string ogrinfo_ = ROADSTEREO_OGRINFO;
};

TEST_F(Ogrinfo, OpensGeoPackage) {
  expect_shown(write_flight(),
               {"using driver `GPKG' successful", "Layer name: frames", "Layer name: damages", "Layer name: sightings",
                "Layer name: footprints", "Layer name: track", "Layer name: layer_styles", "POLYGON ((",
                "time_utc (DateTime) = 2024/05/01 12:01:00+00", "cut_by_border (Integer(Boolean)) = 1",
                "LINESTRING (179.9375 0.0,"});
}

TEST_F(Ogrinfo, OpensGeoJson) {
  expect_shown(write("frames.geojson", frames_geojson(two_frames())),
               {"using driver `GeoJSON' successful", "Feature Count: 2", "POINT Z (-8 50.1234568 123.457)",
                "time_utc: DateTime", "roll_deg: Real"});
  expect_shown(write("sightings.geojson", geojson("sightings.geojson", layers())),
               {"using driver `GeoJSON' successful", "POINT (180", "max_depth_m (Real) = 0.0321"});
  expect_shown(write("damages.geojson", geojson("damages.geojson", layers())),
               {"Geometry: Polygon", "Feature Count: 2", "POLYGON ((", "sightings (Integer) = 4"});
}

}  // namespace
