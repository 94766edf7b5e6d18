#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "roadstereo/io/damage_report.hpp"
#include "roadstereo/io/flight_inventory.hpp"
#include "roadstereo/io/road_segments.hpp"
#include "roadstereo/map_inventory.hpp"

#pragma GCC visibility push(default)
namespace roadstereo::io {

/// Time series of a flight, one value per frame; NaN: unknown.
struct FlightCurves {
  std::vector<double> time;      ///< seconds, or the frame number if the source has no times
  bool in_seconds = false;       ///< unit of `time`
  std::vector<double> roll_deg;  ///< ψ
  std::vector<double> height_m;  ///< above the road
  std::vector<double> sigma_d_px;
};

/// An image with its caption.
struct CaptionedPicture {
  std::string caption;
  std::vector<std::uint8_t> jpeg;
};

/// A damage and its section (`road_damage_section`), which may be empty.
struct ReportedDamage {
  RoadDamage damage;
  std::string section;
};

/// A map of the road (`map_picture`) and the damages whose numbers it shows.
struct ReportedMap {
  std::vector<std::uint8_t> picture;  ///< JPEG
  std::vector<RoadDamageRecord> damages;
};

/// Input of `flight_report`.
struct FlightReportInput {
  std::string title;
  std::vector<std::pair<std::string, std::string>> head;        ///< road, operator, date: name, value
  std::vector<std::pair<std::string, std::string>> properties;  ///< of the processing, for the appendix
  std::vector<std::string> notices;  ///< remarks at the top: rejected frames, an interrupted run
  FlightCurves curves;
  std::int64_t inspected = 0;                    ///< frames in which damage was searched for
  std::int64_t untrusted = 0;                    ///< of these, those whose depths cannot be trusted
  std::vector<CaptionedPicture> thumbnails;      ///< in the order of the flight
  std::vector<ReportedDamage> damages;           ///< all, worst first
  std::vector<RoadDamage> candidates;            ///< all, worst first
  std::vector<std::array<double, 2>> track_deg;  ///< (longitude, latitude) of the frames; NaN: unknown
  std::vector<RoadSegment> segments;
  std::optional<ReportedMap> map;          ///< with inspect --map
  SeverityScheme severity = astm_d6433();  ///< by which the damages were graded
  bool metric = false;                     ///< there is a calibration
  bool flawed = false;                     ///< the notices tell of warnings of the rig
  InspectionLimits limits{};               ///< of the frames
};

/// Returns a self-contained HTML report: styles, scripts and images are embedded.
std::string flight_report(const FlightReportInput& input);

}  // namespace roadstereo::io
#pragma GCC visibility pop
