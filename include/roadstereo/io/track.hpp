#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#pragma GCC visibility push(default)
namespace roadstereo::io {

// Positions of the left camera from a GNSS track, WGS84, angles in degrees. The receiver is assumed at the camera.
// Needs a build with GDAL, GeographicLib and pugixml (CMake option ROADSTEREO_GEO); without it every function here
// throws Error naming the packages.

/// One fix of a GNSS receiver, with standard errors (sd).
struct TrackPoint {
  double time_s = 0;                                              ///< Unix, UTC: 0 … 4102444800 (the year 2100)
  double lat_deg = 0;                                             ///< -90 … 90
  double lon_deg = 0;                                             ///< -180 … 180
  double alt_m = std::numeric_limits<double>::quiet_NaN();        ///< NaN unknown
  double heading_deg = std::numeric_limits<double>::quiet_NaN();  ///< clockwise from north, -360 … 360; NaN unknown
  double horizontal_sd_m = std::numeric_limits<double>::quiet_NaN();  ///< per axis, > 0, finite; NaN unknown
  double vertical_sd_m = std::numeric_limits<double>::quiet_NaN();    ///< of the altitude, > 0, finite; NaN unknown
};

/// A position and the direction of the upper image border of the camera.
struct GeoPosition {
  double lat_deg = 0;
  double lon_deg = 0;                                             ///< -180 … 180
  double alt_m = std::numeric_limits<double>::quiet_NaN();        ///< NaN unknown
  double heading_deg = std::numeric_limits<double>::quiet_NaN();  ///< clockwise from north, 0 … 360; NaN unknown
};

struct TrackOptions {
  double max_gap_s = 5;               ///< no interpolation between points farther apart in time, 0.001 … 3600
  double min_heading_distance_m = 2;  ///< headings are computed over at least this distance, 0.01 … 1000
  double heading_window_s = 5;        ///< ... within ± this time; less movement is standstill, 0.001 … 3600
  double mount_yaw_deg = 0;           ///< yaw of the camera relative to the heading, clockwise, -360 … 360

  /// Throws Error naming the first option out of range.
  void validate() const;
};

/// At least two fixes in chronological order.
class Track {
 public:
  /// Of several points with the same time the first is kept. Outliers, which could be reached and left only at more
  /// than 100 m/s, are left out. Unknown headings are computed from the movement around the point; at standstill the
  /// last heading since the last gap is kept, if any. Throws Error for fewer than two points at different times, and
  /// naming the point that is out of range or earlier than its predecessor.
  explicit Track(std::vector<TrackPoint> points, const TrackOptions& options = {});

  const std::vector<TrackPoint>& points() const { return points_; }
  const std::vector<TrackPoint>& outliers() const { return outliers_; }  ///< left out of points()
  const TrackOptions& options() const { return options_; }

 private:
  std::vector<TrackPoint> points_, outliers_;
  TrackOptions options_;
};

/// Reads a track; the format is recognised by content, not by name:
///   GPX 1.0, 1.1   all trkpt with time (UTC if it has no zone), ele, and course, heading or yaw, also
///                  within extensions; segments may be in any order
///   CSV            header line, then values; separated by commas, semicolons or tabs. Columns in any order:
///                  time, timestamp, time_s, time_utc, datetime, utc: Unix seconds, or ISO 8601 with a zone
///                  lat, latitude, lat_deg; lon, lng, long, longitude, lon_deg: degrees; both empty: no fix, skipped
///                  alt, altitude, ele, elevation, alt_m: metres, may be empty or missing
///                  heading, yaw, course, bearing, heading_deg: degrees, the first of these; may be empty or missing
///                  horizontal_sd_m, h_acc, eph and vertical_sd_m, v_acc, epv: standard errors, metres, may be empty or
///                  missing; what is not above 0 is unknown
///                  time_utc_usec, lat, lon, alt of PX4's vehicle_gps_position, as ulog2csv writes it: microseconds,
///                  1e-7 degrees, millimetres (or latitude_deg, longitude_deg, altitude_msl_m)
///   NMEA 0183      RMC and GGA sentences; those with a wrong checksum or without a fix are left out. Altitudes are
///                  above the ellipsoid where GGA has the geoid separation
///   SRT            subtitles of DJI drones; times are seconds since the start of the video
///   bag            ROS 1, rosbag2 or MCAP with one topic of sensor_msgs/NavSatFix, with its covariances
/// Throws Error naming the file, the line, the value and its limits; also if times decrease.
Track read_track(const std::string& path, const TrackOptions& options = {});

/// Interpolates the position at a time on the geodesic between the neighbouring points. Returns nullopt before the
/// first point, after the last one, in gaps, and between points that could be reached only at more than 100 m/s.
std::optional<GeoPosition> position_at(const Track& track, double time_s);

/// Returns the position `right_m` to the right, `forward_m` in front of and `up_m` above a camera, or nullopt if the
/// heading is unknown. The altitude is NaN if `up_m` is. For a point of the road up_m = -height; a damage of the frame
/// is at DamageMetrics::road_centroid_m: x right, y forward of the left camera's foot.
std::optional<GeoPosition> offset_position(const GeoPosition& from, double right_m, double forward_m,
                                           double up_m = std::numeric_limits<double>::quiet_NaN());

/// Returns the length of the geodesic between two positions, metres; altitudes are ignored.
double distance_m(const GeoPosition& from, const GeoPosition& to);

}  // namespace roadstereo::io
#pragma GCC visibility pop
