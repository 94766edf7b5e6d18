#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "flight/flight_folder.hpp"
#include "flight/flight_positions.hpp"
#include "flight/flight_settings.hpp"
#include "flight/flight_summary.hpp"
#include "roadstereo/io/flight_inventory.hpp"
#include "roadstereo/io/flight_report.hpp"
#include "roadstereo/io/pose_table.hpp"
#include "roadstereo/pipeline.hpp"
#include "roadstereo/pose_graph.hpp"
#include "roadstereo/rig_bias.hpp"

namespace roadstereo::cli {

/// One run over a flight.
struct FlightRun {
  bool complete = false;           ///< the end of the source was reached
  std::string source;              ///< description of the source
  std::string calibration_format;  ///< empty without a calibration
  std::optional<StereoCalibration> calibration;
  std::string engine;  ///< name of the engine used
  int threads = 0;     ///< of matching
  PipelineOptions options;
  double seconds = 0;               ///< of this run
  double frames_per_second = 0;     ///< of this run, from the first frame to the last
  std::int64_t resumed_at = 0;      ///< number of frames done by earlier runs
  std::string crs;                  ///< of the poses of the trajectory; empty: those of cameras
  std::vector<CameraPlace> places;  ///< FlightTrajectory::places
  std::optional<io::ReportedMap> map;
  std::string no_map_reason;      ///< why --map made none
  std::string path;               ///< FlightTrajectory::summary; empty without --trajectory
  std::optional<TrackFit> track;  ///< of the trajectory
  std::string track_unused;       ///< why that does not use the track
  std::string calibration_file;   ///< the first one; empty without, or where the source carries it
  std::string size_doubt;         ///< RectifiedSource::size_doubt
  std::optional<double> expected_height_m, expected_pitch_deg;  ///< --height, --pitch
};

/// Sentences, without a full stop, on the calibration, --height and --pitch, and the clocks of the track, where they
/// contradict what was seen.
std::vector<std::string> run_notices(const FlightRun& run, const FlightSummary& summary);

/// Collects the results of a flight frame by frame and writes its tables, report and GIS files.
class FlightResults {
 public:
  /// Reads the track, if any. Throws Error naming its file and line. `min_confidence`: DamageOptions::min_confidence.
  FlightResults(const TrackSettings& track, double min_confidence);

  /// Adds the next frame. Returns the ids of the road damages of its damages, then of its candidates.
  std::vector<std::int64_t> add(const io::FlightFrame& frame);

  /// Adds what the trajectory tells of the health of the rig.
  void add(const HealthFinding& finding) { summary_.health.add(finding); }

  /// Number of pieces of the motion so far.
  int motion_pieces() const { return motion_pieces_; }

  const io::FlightInventory& inventory() const { return inventory_; }

  /// Writes frames.csv, pose.csv, damages.csv, candidates.csv, sightings.csv, summary.json and report.html, and
  /// segments.csv and the GIS files if there is a track. Completes the summary; call it once. Returns the text of
  /// summary.json.
  std::string write(const FlightSettings& settings, const FlightRun& run, FlightFolder& folder);

  const FlightSummary& summary() const { return summary_; }

 private:
  struct Thumbnail {
    std::int64_t sequence = 0;  ///< number of the frame in the flight
    std::string name;           ///< of the file
    std::string caption;
  };
  std::vector<io::CaptionedPicture> read_thumbnails(const FlightFolder& folder) const;
  std::vector<io::RoadDamage> located_damages() const;
  std::string report(const FlightSettings& settings, const FlightRun& run, const FlightFolder& folder,
                     const std::vector<io::RoadDamage>& damages) const;

  FlightSummary summary_;
  io::FlightInventory inventory_;
  std::optional<FlightPositions> positions_;
  std::vector<Thumbnail> thumbnails_;
  std::string frames_csv_;
  io::PoseTable poses_;
  RigBiasEstimator rig_bias_;
  std::string sightings_csv_;
  int motion_pieces_ = 0;
};

}  // namespace roadstereo::cli
