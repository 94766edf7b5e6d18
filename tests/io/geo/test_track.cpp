#include <gtest/gtest.h>
#include <stdlib.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <numbers>

#include "roadstereo/error.hpp"
#include "roadstereo/io/track.hpp"

namespace {

namespace fs = std::filesystem;
using namespace roadstereo;
using namespace roadstereo::io;

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
constexpr double noon = 1714564800;  // date -u -d 2024-05-01T12:00:00Z +%s

// WGS84.
constexpr double equator_radius_m = 6378137;
constexpr double eccentricity_squared = 0.00669437999014;

/// Metres of a degree of longitude: an arc of the parallel's circle.
double metres_of_longitude(double lat_deg) {
  const double lat = lat_deg * std::numbers::pi / 180;
  const double normal_m = equator_radius_m / std::sqrt(1 - eccentricity_squared * std::sin(lat) * std::sin(lat));
  return normal_m * std::cos(lat) * std::numbers::pi / 180;
}

/// Metres of a degree of latitude near that latitude.
double metres_of_latitude(double lat_deg) {
  const double sine = std::sin(lat_deg * std::numbers::pi / 180);
  const double radius_m =
      equator_radius_m * (1 - eccentricity_squared) / std::pow(1 - eccentricity_squared * sine * sine, 1.5);
  return radius_m * std::numbers::pi / 180;
}

/// A point so many metres from (50°, 8°).
TrackPoint point_at(double time_s, double east_m, double north_m) {
  return {noon + time_s, 50 + north_m / metres_of_latitude(50), 8 + east_m / metres_of_longitude(50), unknown, unknown};
}

double heading_at(const Track& track, double time_s) {
  return position_at(track, noon + time_s).value().heading_deg;
}

double turn_deg(double from_deg, double to_deg) {
  return std::remainder(to_deg - from_deg, 360.0);
}

TEST(TrackPosition, IsInterpolatedInTime) {
  const Track track({{noon, 0, 8, 100, unknown}, {noon + 2, 0.0001, 8, 120, unknown}});
  const GeoPosition position = position_at(track, noon + 0.5).value();
  EXPECT_NEAR(position.lat_deg, 0.000025, 1e-12);
  EXPECT_NEAR(position.lon_deg, 8, 1e-12);
  EXPECT_DOUBLE_EQ(position.alt_m, 105);
  EXPECT_NEAR(turn_deg(0, position.heading_deg), 0, 1e-9);
}

/// Midpoint of a great circle: tan of its latitude is tan 45° over the cosine of half the difference of longitude.
TEST(TrackPosition, FollowsGeodesic) {
  const TrackOptions options{.max_gap_s = 3600};
  const GeoPosition middle = position_at(Track({{noon, 45, 0}, {noon + 3600, 45, 4}}, options), noon + 1800).value();
  EXPECT_NEAR(middle.lon_deg, 2, 1e-9);
  EXPECT_NEAR(middle.lat_deg, 45.01746, 2e-4);  // of a sphere; the parallel would give 45
}

TEST(TrackPosition, CrossesAntimeridian) {
  const Track track({{noon, 10, 179.9999}, {noon + 4, 10, -179.9999}});
  EXPECT_NEAR(position_at(track, noon + 1).value().lon_deg, 179.99995, 1e-9);
  EXPECT_NEAR(std::abs(position_at(track, noon + 2).value().lon_deg), 180, 1e-9);
  EXPECT_NEAR(position_at(track, noon + 3).value().lon_deg, -179.99995, 1e-9);
  EXPECT_NEAR(position_at(track, noon + 3).value().heading_deg, 90, 1e-4);
}

TEST(TrackPosition, IsUnknownOutsideTrackAndInGaps) {
  const Track track({point_at(0, 0, 0), point_at(5, 0, 5), point_at(10.5, 0, 10), point_at(12, 0, 12)});
  for (const double time_s : {-0.001, 12.001, 5.001, 8.0, 10.499, unknown, -1e9, 1e300}) {
    EXPECT_FALSE(position_at(track, noon + time_s)) << time_s;
  }
  for (const double time_s : {0.0, 2.5, 5.0, 10.5, 11.0, 12.0})
    EXPECT_TRUE(position_at(track, noon + time_s)) << time_s;
}

/// At 1 Hz, 10 m/s to the east.
std::vector<TrackPoint> eastward(int points) {
  std::vector<TrackPoint> track;
  for (int i = 0; i < points; ++i) track.push_back(point_at(i, 10.0 * i, 0));
  return track;
}

TEST(TrackOutliers, AreLeftOut) {
  for (const std::vector<int>& wrong : {std::vector{3}, {0}, {9}, {4, 5}, {2, 7}}) {
    std::vector<TrackPoint> points = eastward(10);
    for (const int i : wrong) points[static_cast<std::size_t>(i)].lat_deg += 0.05;  // 5.6 km
    const Track track(points);
    ASSERT_EQ(track.outliers().size(), wrong.size());
    for (std::size_t k = 0; k < wrong.size(); ++k) EXPECT_EQ(track.outliers()[k].time_s, noon + wrong[k]);
    for (const double time_s : {1.5, 3.0, 4.5, 6.5}) {
      const TrackPoint expected = point_at(time_s, 10 * time_s, 0);
      EXPECT_NEAR(position_at(track, noon + time_s).value().lat_deg, expected.lat_deg, 1e-7);
      EXPECT_NEAR(position_at(track, noon + time_s).value().lon_deg, expected.lon_deg, 1e-7);
    }
  }
}

// A receiver that is 5.6 km off for longer than a gap may last: at the start, between, and at the end.
TEST(TrackOutliers, AreWholeStretches) {
  for (const auto& [first, last] : {std::pair{0, 19}, {30, 49}, {80, 99}}) {
    std::vector<TrackPoint> points = eastward(100);
    for (int i = first; i <= last; ++i) points[static_cast<std::size_t>(i)].lat_deg += 0.05;
    const Track track(points);
    ASSERT_EQ(track.outliers().size(), 20U) << first;
    EXPECT_EQ(track.outliers().front().time_s, noon + first);
    EXPECT_EQ(track.outliers().back().time_s, noon + last);
    for (const TrackPoint& point : track.points()) EXPECT_NEAR(point.lat_deg, 50, 1e-9) << first;
  }
}

TEST(TrackOutliers, NoneWhereTrackGoesOnElsewhere) {
  std::vector<TrackPoint> points = eastward(10);
  for (std::size_t i = 5; i < points.size(); ++i) points[i].lat_deg += 1;
  const Track track(points);
  EXPECT_TRUE(track.outliers().empty());
  EXPECT_FALSE(position_at(track, noon + 4.5));
  EXPECT_NEAR(position_at(track, noon + 5.5).value().lat_deg, 51, 1e-6);
}

TEST(TrackPosition, AltitudeNeedsBothNeighbours) {
  const Track track({{noon, 1, 1, 50, 0}, {noon + 1, 1, 1, unknown, 0}});
  EXPECT_DOUBLE_EQ(position_at(track, noon).value().alt_m, 50);
  EXPECT_TRUE(std::isnan(position_at(track, noon + 0.5).value().alt_m));
}

TEST(TrackHeading, TurnsShorterWay) {
  const Track track({{noon, 1, 1, unknown, 350}, {noon + 1, 1, 1, unknown, 10}, {noon + 2, 1, 1, unknown, -10}});
  EXPECT_NEAR(heading_at(track, 0.25), 355, 1e-4);
  EXPECT_NEAR(turn_deg(0, heading_at(track, 0.5)), 0, 1e-4);
  EXPECT_NEAR(heading_at(track, 0.75), 5, 1e-4);
  EXPECT_NEAR(heading_at(track, 2), 350, 1e-9);
}

TEST(TrackHeading, IsTangentOfCurve) {
  std::vector<TrackPoint> points;
  constexpr double radius_m = 30;
  constexpr double rate = 0.2;  // rad/s, clockwise from north
  for (int i = 0; i <= 40; ++i) {
    points.push_back(point_at(i, -radius_m * std::cos(rate * i), radius_m * std::sin(rate * i)));
  }
  const Track track(points);
  for (int i = 2; i <= 78; ++i) {
    const double time_s = i / 2.0;
    EXPECT_NEAR(turn_deg(rate * time_s * 180 / std::numbers::pi, heading_at(track, time_s)), 0, 0.01) << time_s;
  }
}

/// Ten metres to the east at 10 Hz, each fix off by 0.1 m: from one fix to the next the direction is anything.
TEST(TrackHeading, IsMeasuredOverStretch) {
  std::vector<TrackPoint> points;
  for (int i = 0; i <= 100; ++i) points.push_back(point_at(0.1 * i, 0.1 * i, i % 4 < 2 ? 0.1 : -0.1));
  const Track coarse(points, {.min_heading_distance_m = 2});
  const Track fine(points, {.min_heading_distance_m = 0.01});
  double worst_deg = 0;
  double worst_fine_deg = 0;
  for (int i = 20; i <= 80; ++i) {
    worst_deg = std::max(worst_deg, std::abs(turn_deg(90, heading_at(coarse, 0.1 * i))));
    worst_fine_deg = std::max(worst_fine_deg, std::abs(turn_deg(90, heading_at(fine, 0.1 * i))));
  }
  EXPECT_LT(worst_deg, std::atan2(0.2, 2.0) * 180 / std::numbers::pi + 0.01);
  EXPECT_GT(worst_fine_deg, 40);
}

TEST(TrackHeading, StaysWhileStandingStill) {
  std::vector<TrackPoint> points;
  for (int i = 0; i < 10; ++i) points.push_back(point_at(i, 0, 0));
  for (int i = 10; i < 20; ++i) points.push_back(point_at(i, 3 * (i - 10), 0));
  for (int i = 20; i < 60; ++i) points.push_back(point_at(i, 27 + (i % 2 == 0 ? 0.3 : -0.3), i % 3 == 0 ? 0.3 : -0.3));
  points.push_back(point_at(70, 27, 0));
  points.push_back(point_at(71, 27, 0));
  const Track track(points);
  EXPECT_TRUE(std::isnan(heading_at(track, 0)));
  EXPECT_FALSE(offset_position(position_at(track, noon).value(), 1, 1));
  EXPECT_NEAR(heading_at(track, 15), 90, 1e-4);
  EXPECT_NEAR(heading_at(track, 40), 90, 10);
  EXPECT_DOUBLE_EQ(heading_at(track, 40), heading_at(track, 55.5));
  EXPECT_TRUE(std::isnan(heading_at(track, 70.5))) << "what it did in the gap is not known";
}

TEST(TrackHeading, AddsMountingAngle) {
  const std::vector<TrackPoint> points = {point_at(0, 0, 0), point_at(1, 0, 5)};
  EXPECT_NEAR(heading_at(Track(points, {.mount_yaw_deg = 90}), 0.5), 90, 1e-4);
  EXPECT_NEAR(heading_at(Track(points, {.mount_yaw_deg = -90}), 0.5), 270, 1e-4);
}

TEST(OffsetPosition, OneDegreeOfLatitude) {
  const GeoPosition to = offset_position({0, 0, unknown, 0}, 0, 110574.389).value();
  EXPECT_NEAR(to.lat_deg, 1, 1e-8);
  EXPECT_NEAR(to.lon_deg, 0, 1e-12);
}

TEST(OffsetPosition, HundredMetresEast) {
  for (const double lat_deg : {0.0, 50.0, -33.0}) {
    const double expected_deg = 8 + 100 / metres_of_longitude(lat_deg);
    EXPECT_NEAR(offset_position({lat_deg, 8, unknown, 0}, 100, 0).value().lon_deg, expected_deg, 2e-9)
        << "to the right";
    EXPECT_NEAR(offset_position({lat_deg, 8, unknown, 90}, 0, 100).value().lon_deg, expected_deg, 2e-9) << "forward";
    EXPECT_NEAR(offset_position({lat_deg, 8, unknown, 180}, -100, 0).value().lon_deg, expected_deg, 2e-9)
        << "to the left";
    EXPECT_NEAR(offset_position({lat_deg, 8, unknown, 270}, 0, -100).value().lon_deg, expected_deg, 2e-9) << "back";
  }
}

TEST(OffsetPosition, CrossesAntimeridian) {
  const double step_deg = 100 / metres_of_longitude(0);
  const GeoPosition to = offset_position({0, 180 - step_deg / 4, unknown, 90}, 0, 100).value();
  EXPECT_NEAR(to.lon_deg, -180 + 0.75 * step_deg, 1e-9);
}

TEST(OffsetPosition, NeedsHeading) {
  const GeoPosition from{50, 8, 120, 30};
  EXPECT_TRUE(std::isnan(offset_position(from, 1, 1).value().alt_m));
  EXPECT_DOUBLE_EQ(offset_position(from, 1, 1, -4).value().alt_m, 116);
  EXPECT_DOUBLE_EQ(offset_position(from, 1, 1).value().heading_deg, 30);
  EXPECT_DOUBLE_EQ(offset_position(from, 0, 0).value().lat_deg, 50);
  EXPECT_FALSE(offset_position({50, 8, 120, unknown}, 1, 1));
  EXPECT_FALSE(offset_position(from, unknown, 1));
}

void expect_error(const std::function<void()>& call, const std::string& part) {
  try {
    call();
    FAIL() << "no error; expected " << part;
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}

TEST(TrackPoints, EqualTimesKeepFirst) {
  const Track track({{noon, 1, 1}, {noon, 2, 2}, {noon + 1, 1, 1}, {noon + 1, 3, 3}});
  ASSERT_EQ(track.points().size(), 2U);
  EXPECT_EQ(track.points()[1].lat_deg, 1);
}

TEST(TrackPoints, RejectsBadPoints) {
  expect_error([] { Track({{noon, 0, 0}}); }, "the track has 1 point(s); it must have at least two");
  expect_error([] { Track({{noon, 0, 0}, {noon, 1, 1}}); }, "the track has 1 point(s); it must have at least two");
  expect_error([] { Track({{noon, 0, 0}, {noon - 2, 0, 0}}); }, "point 1 of the track is 2 s before its predecessor");
  expect_error([] { Track({{noon, 0, 0}, {noon, 90.5, 0}}); }, "lat_deg is 90.5; it must be between -90 and 90");
  expect_error([] { Track({{noon, 0, 0}, {noon, 0, unknown}}); }, "lon_deg is nan");
  expect_error([] { Track({{noon * 1000, 0, 0}, {noon, 0, 0}}); }, "time_s is 1.7145648e+12; it must be between 0");
  expect_error(
      [] {
        Track({{noon, 0, 0}, {noon + 1, 0, 0, unknown, unknown, 0}});
      },
      "point 1 of the track: horizontal_sd_m is 0; it must be above 0");
  expect_error(
      [] {
        Track({{noon, 0, 0, unknown, unknown, 1, -2}, {noon + 1, 0, 0}});
      },
      "point 0 of the track: vertical_sd_m is -2; it must be above 0");
  expect_error([] { Track({{noon, 0, 0}, {noon + 1, 0, 0}}, {.max_gap_s = 0}); }, "track.max_gap_s is 0");
  expect_error([] { TrackOptions{.min_heading_distance_m = unknown}.validate(); },
               "track.min_heading_distance_m is nan");
}

class TrackFile : public testing::Test {
 protected:
  TrackFile() {
    std::string name = (fs::temp_directory_path() / "roadstereo-track-XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
  }
  ~TrackFile() override { fs::remove_all(folder_); }

  std::string write(const std::string& text) const {
    const fs::path path = folder_ / "track";
    std::ofstream(path, std::ios::binary) << text;
    return path.string();
  }
  std::vector<TrackPoint> points(const std::string& text) const { return read_track(write(text)).points(); }

  /// Expects one sentence that begins with the file's name and says `part`.
  void expect_refused(const std::string& text, const std::string& part) const {
    const std::string path = write(text);
    testing::internal::CaptureStderr();
    std::string message = "no error";
    try {
      read_track(path);
    } catch (const Error& error) {
      message = error.what();
    }
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    EXPECT_TRUE(message.starts_with(path + ": ")) << message;
    EXPECT_NE(message.find(part), std::string::npos) << message << "\nexpected: " << part;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }

 private:
  fs::path folder_;
};

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

const std::string gpx = R"(<?xml version="1.0" encoding="UTF-8"?>
<gpx version="1.1" creator="logger" xmlns="http://www.topografix.com/GPX/1/1">
  <metadata><time>2020-01-01T00:00:00Z</time></metadata>
  <wpt lat="1" lon="2"><name>home</name></wpt>
  <trk><name>second</name><trkseg>
    <trkpt lat="50.0002" lon="8.0"><ele>101.5</ele><time>2024-05-01T12:00:02.250Z</time></trkpt>
    <trkpt lat="50.0003" lon="8.0"><time>2024-05-01T14:00:03+02:00</time>
      <extensions><x:TrackPointExtension xmlns:x="y"><x:course>12.5</x:course></x:TrackPointExtension></extensions>
    </trkpt>
  </trkseg></trk>
  <trk><trkseg/><trkseg>
    <trkpt lat="50.0000" lon="8.0"><ele>100</ele><time>2024-05-01T12:00:00</time></trkpt>
    <trkpt lat="50.0001" lon="8.0"><ele>101</ele><time>2024-05-01T12:00:01.125Z</time></trkpt>
  </trkseg></trk>
</gpx>
)";

TEST_F(TrackFile, ReadsGpx) {
  const std::vector<TrackPoint> read = points(gpx);
  ASSERT_EQ(read.size(), 4U);
  const std::array<double, 4> times = {0, 1.125, 2.25, 3};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_DOUBLE_EQ(read[i].time_s, noon + times.at(i));
    EXPECT_DOUBLE_EQ(read[i].lat_deg, 50 + 0.0001 * static_cast<double>(i));
    EXPECT_DOUBLE_EQ(read[i].lon_deg, 8);
  }
  EXPECT_DOUBLE_EQ(read[2].alt_m, 101.5);
  EXPECT_TRUE(std::isnan(read[3].alt_m));
  EXPECT_NEAR(turn_deg(0, read[1].heading_deg), 0, 1e-6) << "of the way";
  EXPECT_DOUBLE_EQ(read[3].heading_deg, 12.5);
}

TEST_F(TrackFile, ReadsGpx10WithPrefix) {
  const std::vector<TrackPoint> read = points(
      "\xef\xbb\xbf<g:gpx version='1.0' xmlns:g='http://www.topografix.com/GPX/1/0'><g:trk><g:trkseg>\n"
      "<g:trkpt lat='-1' "
      "lon='-2'><g:ele>3</g:ele><g:time>2024-05-01T12:00:00Z</g:time><g:course>270</g:course></g:trkpt>\n"
      "<g:trkpt lat='-1' lon='-2.1'><g:time>2024-05-01T12:00:01Z</g:time><g:course>280</g:course></g:trkpt>\n"
      "</g:trkseg></g:trk></g:gpx>");
  ASSERT_EQ(read.size(), 2U);
  EXPECT_DOUBLE_EQ(read[0].heading_deg, 270);
  EXPECT_DOUBLE_EQ(read[0].alt_m, 3);
  EXPECT_DOUBLE_EQ(read[1].lon_deg, -2.1);
}

TEST_F(TrackFile, RejectsBadGpx) {
  expect_refused(replaced(gpx, "50.0003", "91"), "line 7: lat is 91; it must be between -90 and 90 degrees");
  expect_refused(replaced(gpx, "50.0003", "north"), "line 7: lat is \"north\"; it must be a number");
  expect_refused(replaced(gpx, "lat=\"50.0003\"", ""), "line 7: this trkpt has no lat");
  expect_refused(replaced(gpx, "lon=\"8.0\"", "lon=\"-180.5\""),
                 "line 6: lon is -180.5; it must be between -180 and 180");
  expect_refused(replaced(gpx, "2024-05-01T12:00:01.125Z", "2024-05-01"),
                 "line 13: time is \"2024-05-01\"; it must be like");
  expect_refused(replaced(gpx, "2024-05-01T12:00:01.125Z", "2024-02-30T12:00:01Z"), "line 13: time is");
  expect_refused(replaced(gpx, "2024-05-01T12:00:01.125Z", "1924-05-01T12:00:01Z"), "seconds since 1970; it must be");
  expect_refused(replaced(gpx, "<time>2024-05-01T12:00:01.125Z</time>", ""), "line 13: this trkpt has no <time>");
  expect_refused(replaced(gpx, "12:00:01.125Z", "11:59:58Z"), "line 13: the time is 2 s before that of line 12;");
  expect_refused(replaced(gpx, "12:00:01.125Z", "12:00:02.5Z"), "line 6: the time is 0.25 s before that of line 13;");
  expect_refused(replaced(gpx, ">12.5<", ">361<"), "line 7: course is 361; it must be between -360 and 360");
  expect_refused(replaced(gpx, "</gpx>", "</xyz>"), "invalid XML");
  expect_refused("<kml><Document/></kml>", "the root element is <kml>; a track must be GPX or CSV");
  expect_refused("<gpx><trk><trkseg/></trk></gpx>", "the track has no points with a time");
  expect_refused(
      "<gpx><trk><trkseg><trkpt lat='1' lon='1'><time>2024-05-01T12:00:00Z</time></trkpt></trkseg></trk></gpx>",
      "the track has 1 point(s) at one time");
}

const std::string csv =
    "time,lat,lon,alt,heading\n"
    "1714564800.25,50,8,100.5,350\n"
    "1714564801.25,50.0001,8.0001,,\n"
    "1714564802.25,50.0002,8.0002,nan,10\n";

void expect_as_csv(const std::vector<TrackPoint>& read) {
  ASSERT_EQ(read.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_DOUBLE_EQ(read[i].time_s, noon + 0.25 + static_cast<double>(i));
    EXPECT_DOUBLE_EQ(read[i].lat_deg, 50 + 0.0001 * static_cast<double>(i));
    EXPECT_DOUBLE_EQ(read[i].lon_deg, 8 + 0.0001 * static_cast<double>(i));
  }
  EXPECT_DOUBLE_EQ(read[0].alt_m, 100.5);
  EXPECT_TRUE(std::isnan(read[1].alt_m));
  EXPECT_DOUBLE_EQ(read[0].heading_deg, 350);
  EXPECT_DOUBLE_EQ(read[2].heading_deg, 10);
}

TEST_F(TrackFile, ReadsCsv) {
  expect_as_csv(points(csv));
}

TEST_F(TrackFile, ReadsCsvDialects) {
  expect_as_csv(
      points("\xef\xbb\xbf# a logger's file\r\n\r\n\"Longitude\";Note;Latitude;Timestamp;Course;Yaw;Ele\r\n"
             "8;\"a; b\";50;2024-05-01T14:00:00.25+02:00;1;350;100.5\r\n"
             ";no fix;;2024-05-01T12:00:00.75Z;;;\r\n"
             "8.0001;;50.0001;2024-05-01 12:00:01.250Z;2;;\r\n"
             "8.0002;;50.0002;2024-05-01T07:00:02,25-0500;3;10;"));
  expect_as_csv(
      points("lat\tlng\ttime\tbearing\taltitude\n50\t8\t1714564800.25\t350\t100.5\n"
             "50.0001\t8.0001\t1714564801.25\t\t\n50.0002\t8.0002\t1714564802.25\t10\t\n"));
}

TEST_F(TrackFile, ReadsCsvWithoutAltitudeAndHeading) {
  const std::vector<TrackPoint> read = points("lon,lat,time\n8,50,10\n8,50.0001,11\n");
  ASSERT_EQ(read.size(), 2U);
  EXPECT_TRUE(std::isnan(read[0].alt_m));
  EXPECT_NEAR(turn_deg(0, read[0].heading_deg), 0, 1e-6) << "of the way";
}

TEST_F(TrackFile, LeavesOutRowsBeforeFirstFix) {
  const std::vector<TrackPoint> read = points("time,lat,lon\n8,0,0\n9,0.0,0.0\n10,50,8\n11,50.0001,8\n12,50.0002,8\n");
  ASSERT_EQ(read.size(), 3U);
  EXPECT_EQ(read[0].lat_deg, 50);
  expect_refused("time,lat,lon\n8,0,0\n9,0,0\n", "the track has no points");
}

/// The course of a receiver that stands is noise; a heading, of a compass, is not.
TEST_F(TrackFile, IgnoresCourseOfCsvWhileStanding) {
  const std::string rows = "10,50,8,90,0.1\n11,50.0001,8,90,8\n12,50.0002,8,90,8\n";
  const std::vector<TrackPoint> course = points("time,lat,lon,bearing,speed\n" + rows);
  EXPECT_NEAR(turn_deg(0, course[0].heading_deg), 0, 1e-6) << "of the way";
  EXPECT_DOUBLE_EQ(course[1].heading_deg, 90);
  EXPECT_DOUBLE_EQ(points("time,lat,lon,bearing,speed\n10,50,8,90,nan\n11,50.0001,8,90,\n")[0].heading_deg, 90);
  EXPECT_DOUBLE_EQ(points("time,lat,lon,heading,speed\n" + rows)[0].heading_deg, 90);
}

TEST_F(TrackFile, ReadsNmea) {
  const std::vector<TrackPoint> read = points(
      "$GPGGA,123519,4807.038,N,01131.000,E,1,08,0.9,545.4,M,46.9,M,,*47\r\n"
      "$GPRMC,123519,A,4807.038,N,01131.000,E,022.4,084.4,230394,003.1,W*6A\r\n"
      "$GPRMC,123520,A,4807.038,N,01131.000,E,022.4,084.4,230394,003.1,W*6A\r\n"  // a wrong checksum
      "$GNRMC,123520.50,A,4807.0390,N,01131.0000,W,022.4,,230394,,,A*76\r\n"
      "$GNGGA,123520.50,4807.0390,N,01131.0000,W,1,08,0.9,546.0,M,46.9,M,,*6C\r\n"
      "$GPRMC,123521,V,,,,,,,230394,,*38\r\n");  // no fix
  ASSERT_EQ(read.size(), 2U);
  EXPECT_DOUBLE_EQ(read[0].time_s, 764426119);  // 1994-03-23T12:35:19Z
  EXPECT_DOUBLE_EQ(read[1].time_s, 764426120.5);
  EXPECT_NEAR(read[0].lat_deg, 48.1173, 1e-9);  // 7.038 minutes
  EXPECT_NEAR(read[0].lon_deg, 11 + 31.0 / 60, 1e-9);
  EXPECT_NEAR(read[1].lon_deg, -11 - 31.0 / 60, 1e-9);
  EXPECT_DOUBLE_EQ(read[0].alt_m, 545.4 + 46.9) << "above the ellipsoid";
  EXPECT_DOUBLE_EQ(read[1].alt_m, 546.0 + 46.9);
  EXPECT_DOUBLE_EQ(read[0].heading_deg, 84.4);
  expect_refused("$GPRMC,123519,A,4807.038,N,01131.000,E,022.4,084.4,230394,003.1,W*6B\n", "right checksum");
}

std::string nmea_line(const std::string& body) {
  unsigned sum = 0;
  for (const char letter : body) sum ^= static_cast<unsigned char>(letter);
  char line[120];
  std::snprintf(line, sizeof line, "$%s*%02X\r\n", body.c_str(), sum);
  return line;
}

TEST_F(TrackFile, NmeaPositionOutsideOfEarthIsRefused) {
  const auto fix = [](const std::string& position, const char* second = "19") {
    return nmea_line(std::string("GPRMC,1235") + second + ",A," + position + ",022.4,084.4,230394,003.1,W");
  };
  EXPECT_EQ(points(fix("9000.000,S,18000.000,W") + fix("4807.038,N,01131.000,E", "20")).size(), 2U);
  expect_refused(fix("9930.000,N,01131.000,E"), "the latitude is 9930.000");
  expect_refused(fix("4860.000,N,01131.000,E"), "the latitude is 4860.000");
  expect_refused(fix("4807.038,,01131.000,E"), "the side of the latitude is \"\"");
  expect_refused(fix("4807.038,N,01131.000,N"), "the side of the longitude is \"N\"");
}

// A receiver that stands still tells any course. 0.5 m/s are 0.972 knots.
TEST_F(TrackFile, CourseOfStandingReceiverIsNoHeading) {
  std::string nmea;
  for (const auto& [second, speed, course] :
       {std::tuple{"19", "005.0", "084.4"}, std::tuple{"20", "000.05", "211.0"}, std::tuple{"21", "000.96", "300.0"},
        std::tuple{"22", "000.98", "090.0"}}) {
    nmea += nmea_line(std::string("GPRMC,1235") + second + ",A,4807.038,N,01131.000,E," + speed + "," + course +
                      ",230394,003.1,W");
  }
  const std::vector<TrackPoint> read = points(nmea);
  ASSERT_EQ(read.size(), 4U);
  const double expected[] = {84.4, 84.4, 84.4, 90.0};  // the last one stays
  for (std::size_t i = 0; i < 4; ++i) EXPECT_DOUBLE_EQ(read[i].heading_deg, expected[i]) << i;

  std::string segment = "<gpx><trk><trkseg>";
  for (const auto& [second, speed, course] : {std::tuple{"19", "5", "84.4"}, std::tuple{"20", "0.4", "211"}}) {
    segment += std::string("<trkpt lat=\"48\" lon=\"11\"><time>1994-03-23T12:35:") + second + "Z</time><course>" +
               course + "</course><speed>" + speed + "</speed></trkpt>";
  }
  const std::vector<TrackPoint> of_gpx = points(segment + "</trkseg></trk></gpx>");
  ASSERT_EQ(of_gpx.size(), 2U);
  for (const TrackPoint& point : of_gpx) EXPECT_DOUBLE_EQ(point.heading_deg, 84.4);
}

TEST_F(TrackFile, ReadsSubtitlesOfDrones) {
  const std::vector<TrackPoint> read = points(
      "1\n00:00:00,000 --> 00:00:00,033\n<font size=\"28\">SrtCnt : 1, DiffTime : 33ms\n2022-08-22 10:13:23.001\n"
      "[iso : 100] [shutter : 1/500.0] [latitude: 48.137100] [longitude: 11.575400] [rel_alt: 1.300 abs_alt: 520.125] "
      "</font>\n\n"
      "2\n00:00:00,033 --> 00:00:00,066\n[latitude : 0.0] [longtitude : 0.0] [altitude: 0]\n\n"
      "3\n00:01:02,345 --> 00:01:02,378\n[latitude : 48.1372] [longtitude : 11.5755] [altitude: 521.5]\n\n");
  ASSERT_EQ(read.size(), 2U);
  EXPECT_DOUBLE_EQ(read[0].time_s, 0);
  EXPECT_DOUBLE_EQ(read[1].time_s, 62.345);
  EXPECT_DOUBLE_EQ(read[0].lat_deg, 48.1371);
  EXPECT_DOUBLE_EQ(read[1].lon_deg, 11.5755);
  EXPECT_DOUBLE_EQ(read[0].alt_m, 520.125);
  EXPECT_DOUBLE_EQ(read[1].alt_m, 521.5);
  const std::vector<TrackPoint> older = points(
      "1\n00:00:01,000 --> 00:00:02,000\nHOME(11.5000,48.1000) 2017.08.05 14:11:51\nGPS(11.5754,48.1371,19) "
      "BAROMETER:25.2\nISO:100 Shutter:60\n\n"
      "2\n00:00:02,000 --> 00:00:03,000\nGPS(11.5755, 48.1372,19) BAROMETER:25.3\n\n");
  ASSERT_EQ(older.size(), 2U);
  EXPECT_DOUBLE_EQ(older[0].lat_deg, 48.1371);
  EXPECT_DOUBLE_EQ(older[1].lon_deg, 11.5755);
  EXPECT_DOUBLE_EQ(older[1].alt_m, 25.3);
  expect_refused("1\n00:00:01,000 --> 00:00:02,000\n[latitude: 148.1] [longitude: 11.5]\n",
                 "line 3: latitude is 148.1");
}

TEST_F(TrackFile, ReadsPositionsOfPx4) {
  const std::vector<TrackPoint> old_units = points(
      "timestamp,time_utc_usec,lat,lon,alt,fix_type\n1000,0,0,0,0,0\n"
      "2000,1714564800000000,481371000,115754000,520125,3\n3000,1714564800200000,481372000,115755000,520225,3\n");
  ASSERT_EQ(old_units.size(), 2U);
  EXPECT_DOUBLE_EQ(old_units[0].time_s, 1714564800);
  EXPECT_NEAR(old_units[1].time_s, 1714564800.2, 1e-6);
  EXPECT_DOUBLE_EQ(old_units[0].lat_deg, 48.1371);
  EXPECT_DOUBLE_EQ(old_units[1].lon_deg, 11.5755);
  EXPECT_DOUBLE_EQ(old_units[0].alt_m, 520.125);
  const std::vector<TrackPoint> new_units = points(
      "timestamp,time_utc_usec,latitude_deg,longitude_deg,altitude_msl_m\n"
      "2000,1714564800000000,48.1371,11.5754,520.125\n3000,1714564800200000,48.1372,11.5755,520.225\n");
  EXPECT_DOUBLE_EQ(new_units[1].lat_deg, 48.1372);
  EXPECT_DOUBLE_EQ(new_units[1].alt_m, 520.225);
}

TEST_F(TrackFile, UnknownNumbersOfPx4AreNone) {
  const std::vector<TrackPoint> read = points(
      "timestamp,time_utc_usec,latitude_deg,longitude_deg,altitude_msl_m,eph,epv\n"
      "2000,1714564800000000,48.1371,11.5754,nan,nan,NaN\n3000,1714564800200000,48.1372,11.5755,520.225,1.5,\n");
  ASSERT_EQ(read.size(), 2U);
  EXPECT_TRUE(std::isnan(read[0].alt_m) && std::isnan(read[0].horizontal_sd_m) && std::isnan(read[0].vertical_sd_m));
  EXPECT_EQ(read[1].horizontal_sd_m, 1.5);
  EXPECT_TRUE(std::isnan(read[1].vertical_sd_m));
}

TEST_F(TrackFile, RejectsBadCsv) {
  expect_refused(replaced(csv, "50.0001", "-90.1"), "line 3: lat is -90.1; it must be between -90 and 90 degrees");
  expect_refused(replaced(csv, "8.0002", "200"), "line 4: lon is 200; it must be between -180 and 180 degrees");
  expect_refused(replaced(csv, "50.0001", "nan"), "line 3: lat is nan; it must be a finite number");
  expect_refused(replaced(csv, "50.0001", ""), "line 3: lat is \"\"; it must be a number");
  expect_refused(replaced(csv, "350", "361"), "line 2: heading is 361; it must be between -360 and 360");
  expect_refused(replaced(csv, "100.5", "high"), "line 2: alt is \"high\"");
  expect_refused(replaced(csv, "100.5", "inf"), "line 2: alt is inf; it must be a finite number");
  expect_refused(replaced(csv, "1714564801.25", "1714564801250"), "line 3: time is 1.71456480");
  expect_refused(replaced(csv, "1714564801.25", "1714564799"), "line 3: the time is 1.25 s before that of line 2;");
  expect_refused(replaced(csv, "1714564801.25", "2024-05-01T12:00:01"), "without a zone; it must end with Z");
  expect_refused(replaced(csv, "1714564801.25", "12:00:01"),
                 "line 3: time is \"12:00:01\"; it must be Unix seconds, or");
  expect_refused(replaced(csv, "1714564801.25", "2024-05-01T25:00:01Z"), "line 3: time is \"2024-05-01T25:00:01Z\"");
  expect_refused(replaced(csv, "1714564801.25", "-5"), "line 3: time is -5 seconds since 1970; it must be between 0");
  expect_refused(replaced(csv, ",,", ","), "line 3: the line has 4 cells; the header line has 5");
  expect_refused(replaced(csv, "lat", "x"), "line 1: there is no column lat; a track is GPX, or CSV");
  expect_refused(csv.substr(0, csv.find('\n')), "the track has no points with a time");
  expect_refused("time,lat,lon\n5,1,1\n5,2,2\n",
                 "the track has 2 point(s) at one time; it must have at least two times");
  expect_refused("\n \n", "the file has no header line");
  expect_refused("", "the file is empty");
  expect_refused(std::string("a\0b", 3), "neither a text file nor a bag");
}

/// Whatever a file holds, it is a track or an Error.
TEST_F(TrackFile, DamagedFilesNeverCrash) {
  const std::string small_gpx =
      "<gpx><trk><trkseg><trkpt lat='1' lon='1'><time>2024-05-01T12:00:00Z</time><ele>1</ele></trkpt>"
      "<trkpt lat='1' lon='2'><time>2024-05-01T12:00:01.5Z</time></trkpt></trkseg></trk></gpx>";
  for (const std::string& whole : {small_gpx, csv}) {
    std::size_t read = 0;
    for (std::size_t i = 0; i < whole.size(); i += 3) {
      std::string changed = whole;
      changed[i] = static_cast<char>(changed[i] ^ 2);
      for (const std::string& text : {whole.substr(0, i), changed}) {
        try {
          read += points(text).size() >= 2 ? 1 : 0;
        } catch (const Error&) {
          continue;
        }
      }
    }
    EXPECT_GT(read, 0U);
    EXPECT_LT(read, 2 * whole.size() / 3);
  }
}

}  // namespace
