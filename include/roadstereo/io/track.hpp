#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace roadstereo::io {

// Where the left camera was: the receiver is taken to be there. WGS84 throughout; angles in degrees, as in the files.
// Needs a build with GDAL, GeographicLib and pugixml (CMake's ROADSTEREO_GEO); without it every function here throws
// Error naming the packages.

/// One fix of a receiver.
struct TrackPoint {
  double time_s = 0;                                              ///< Unix, UTC: 0 … 4102444800 (the year 2100)
  double lat_deg = 0;                                             ///< -90 … 90
  double lon_deg = 0;                                             ///< -180 … 180
  double alt_m = std::numeric_limits<double>::quiet_NaN();        ///< NaN unknown
  double heading_deg = std::numeric_limits<double>::quiet_NaN();  ///< clockwise from north, -360 … 360; NaN unknown
};

/// A place and the direction in which the camera's upper image border looks there.
struct Place {
  double lat_deg = 0;
  double lon_deg = 0;                                             ///< -180 … 180
  double alt_m = std::numeric_limits<double>::quiet_NaN();        ///< NaN unknown
  double heading_deg = std::numeric_limits<double>::quiet_NaN();  ///< clockwise from north, 0 … 360; NaN unknown
};

struct TrackOptions {
  double max_gap_s = 5;          ///< points farther apart in time have no places between them, 0.001 … 3600
  double heading_stretch_m = 2;  ///< headings of the track are taken over at least this way, 0.01 … 1000
  double heading_window_s = 5;   ///< ... within this time before and after; else it stands still, 0.001 … 3600
  double mount_yaw_deg = 0;      ///< the camera's forward against the heading, clockwise, -360 … 360

  /// Throws Error naming the first option that is out of range.
  void validate() const;
};

/// At least two fixes, in the order of time.
class Track {
 public:
  /// Points of one time are one: the first. Headings that are not known are those of the way travelled around the
  /// point; where it stands still, the last known one since the last gap, else none.
  /// Throws Error naming the point that is out of range or earlier than the one before it.
  explicit Track(std::vector<TrackPoint> points, const TrackOptions& options = {});

  const std::vector<TrackPoint>& points() const { return points_; }
  const TrackOptions& options() const { return options_; }

 private:
  std::vector<TrackPoint> points_;
  TrackOptions options_;
};

/// Reads a track; the format is recognised by content, not by name:
///   GPX 1.0, 1.1   all trkpt with time (UTC where it has no zone), ele, and course, heading or yaw, also within
///                  extensions; segments may be in any order
///   CSV            a line of names, then values, between commas, semicolons or tabs. In any order, others ignored:
///                  time, timestamp, time_s, time_utc, datetime, utc: Unix seconds, or ISO 8601 with a zone
///                  lat, latitude, lat_deg; lon, lng, long, longitude, lon_deg: degrees; both empty: no fix, left out
///                  alt, altitude, ele, elevation, alt_m: metres, may be empty or missing
///                  heading, yaw, course, bearing, heading_deg: degrees, the first of these; may be empty or missing
/// Throws Error naming the file, the line, the value and its limits; also where times step back.
Track read_track(const std::string& path, const TrackOptions& options = {});

/// The place at a time, on the geodesic between the points before and after. Nothing before the track's first point,
/// after its last one, and in gaps.
std::optional<Place> place_at(const Track& track, double time_s);

/// The place so many metres to the right of a camera and before it. Its altitude is known when `up_m` is: a point of
/// the road lies up_m = -height. Nothing when the heading is unknown. A damage of the frame lies at
/// DamageMetrics::road_centroid_m: x to the right, y forward of the left camera's foot.
std::optional<Place> offset_place(const Place& from, double right_m, double forward_m,
                                  double up_m = std::numeric_limits<double>::quiet_NaN());

}  // namespace roadstereo::io
