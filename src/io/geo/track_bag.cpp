#include <cmath>
#include <limits>

#include "io/geo/track_formats.hpp"
#include "io/source/message_log.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

/// The only topic of that type. Throws Error unless there is exactly one.
BagTopic fix_topic(const std::string& path, const std::vector<BagTopic>& topics) {
  std::vector<BagTopic> fixes;
  for (const BagTopic& topic : topics) {
    if (topic.type == "sensor_msgs/NavSatFix") fixes.push_back(topic);
  }
  if (fixes.empty()) fail(path, ": the bag has no topic of sensor_msgs/NavSatFix, and so no track");
  if (fixes.size() == 1) return fixes.front();
  std::string names;
  for (const BagTopic& topic : fixes) names += (names.empty() ? "" : ", ") + topic.name;
  fail(path, ": the bag has ", fixes.size(), " topics of sensor_msgs/NavSatFix; it must have one: ", names);
}

/// NaN unless the receiver knows it.
double root_of_variance(double variance_m2) {
  const bool known = variance_m2 > 0 && std::isfinite(variance_m2);
  return known ? std::sqrt(variance_m2) : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

std::vector<TrackLine> read_track_bag(const std::string& path) {
  const std::unique_ptr<MessageLog> log = open_message_log(path);
  const BagTopic topic = fix_topic(path, log->topics());
  log->select({topic.name});
  std::vector<TrackLine> points;
  std::size_t number = 0;
  while (const std::optional<LoggedMessage> message = log->next()) {
    if (!message->error.empty()) continue;  // a gap in the track
    ++number;
    const SatelliteFix fix = read_satellite_fix(path + ": " + topic.name, message->bytes, topic.format);
    if (!fix.valid || !std::isfinite(fix.lat_deg) || !std::isfinite(fix.lon_deg)) continue;
    TrackPoint point;
    point.time_s = 1e-9 * static_cast<double>(fix.stamp_ns == 0 ? message->received_ns : fix.stamp_ns);
    point.lat_deg = fix.lat_deg;
    point.lon_deg = fix.lon_deg;
    point.alt_m = fix.alt_m;
    point.horizontal_sd_m = root_of_variance(fix.horizontal_variance_m2);
    point.vertical_sd_m = root_of_variance(fix.vertical_variance_m2);
    points.push_back({point, number});
  }
  return points;
}

}  // namespace roadstereo::io
