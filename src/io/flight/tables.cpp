
#include "core/degrees.hpp"
#include "io/csv.hpp"
#include "io/damage_columns.hpp"
#include "roadstereo/io/flight_tables.hpp"

namespace roadstereo::io {
namespace {

/// The warnings of the pipeline in one cell.
std::string remarks(const FlightFrame& frame) {
  std::string text = frame.reason;
  for (const std::string& warning : frame.warnings) text += (text.empty() ? "" : "; ") + warning;
  return text;
}

/// Status of the road model used for matching.
const char* road_status(const FlightFrame& frame) {
  return frame.status == FrameStatus::good ? name_of(frame.road_status) : "";
}

}  // namespace

std::string frames_csv_names() {
  CsvLine line;
  for (const char* name : {"frame",
                           "name",
                           "time_s",
                           "status",
                           "roll_deg",
                           "roll_stderr_deg",
                           "roll_observable",
                           "road",
                           "alpha0_px",
                           "alpha1",
                           "a0_px",
                           "a1",
                           "a2",
                           "height_m",
                           "height_stderr_m",
                           "pitch_deg",
                           "pitch_stderr_deg",
                           "sigma_d_px",
                           "road_noise_px",
                           "valid_percent",
                           "damages",
                           "matching_ms",
                           "damage_ms",
                           "warnings"}) {
    line.add(name);
  }
  return line.end();
}

std::string frames_csv_row(const FlightFrame& frame) {
  const bool good = frame.status == FrameStatus::good;
  CsvLine line;
  line.add(frame.index).add(frame.name).add(frame.time_s).add(name_of(frame.status));
  line.add(to_degrees(frame.roll_rad)).add(to_degrees(frame.roll_stderr_rad));
  good ? line.add(frame.roll_observable) : line.add_nothing();
  line.add(road_status(frame)).add(frame.alpha0).add(frame.alpha1);
  line.add(frame.road.a0).add(frame.road.a1).add(frame.road.a2);
  line.add(frame.height_m).add(frame.height_stderr_m);
  line.add(to_degrees(frame.pitch_rad))
      .add(to_degrees(frame.pitch_stderr_rad))
      .add(frame.sigma_d_px)
      .add(frame.noise_px);
  line.add(100 * frame.valid_share);
  good ? line.add(frame.damages.size()) : line.add_nothing();
  line.add(frame.matching_ms, 2).add(frame.damage_ms, 2).add(remarks(frame));
  return line.end();
}

std::string sightings_csv_names() {
  CsvLine line;
  line.add("road_damage").add("frame").add("name").add("time_s");
  add_damage_names(line);
  return line.end();
}

std::string sightings_csv_rows(const FlightFrame& frame, const std::vector<std::int64_t>& road_damages) {
  std::string rows;
  for (std::size_t i = 0; i < frame.damages.size(); ++i) {
    CsvLine line;
    line.add(road_damages[i]).add(frame.index).add(frame.name).add(frame.time_s);
    add_damage_cells(frame.damages[i], line);
    rows += line.end();
  }
  return rows;
}

}  // namespace roadstereo::io
