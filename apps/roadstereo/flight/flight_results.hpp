#pragma once

#include <optional>
#include <string>

#include "flight/flight_folder.hpp"
#include "flight/flight_positions.hpp"
#include "flight/flight_settings.hpp"
#include "flight/flight_summary.hpp"
#include "flight/rectified_source.hpp"
#include "roadstereo/io/flight_journal.hpp"

namespace roadstereo::cli {

/// One run over a flight.
struct FlightRun {
  bool complete = false;           ///< the end of the source was reached
  std::string source;              ///< description of the source
  std::string calibration_format;  ///< empty without a calibration
  std::string engine;              ///< name of the engine used
  int threads = 0;                 ///< of matching
  PipelineOptions options;
  double seconds = 0;            ///< of this run
  double frames_per_second = 0;  ///< of this run, from the first frame to the last
  std::int64_t resumed_at = 0;   ///< number of frames done by earlier runs
};

/// Writes frames.csv, damages.csv, summary.json and report.html from the journal, and the GIS files if `positions` is
/// set. Fills `positions` and `summary`. Returns the text of summary.json.
std::string write_flight_results(const FlightSettings& settings, const FlightRun& run, const io::FlightJournal& journal,
                                 std::optional<FlightPositions>& positions, FlightFolder& folder,
                                 FlightSummary& summary);

}  // namespace roadstereo::cli
