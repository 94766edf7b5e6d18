#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "flight/flight_job.hpp"
#include "roadstereo/io/flight_inventory.hpp"
#include "roadstereo/io/output_folder.hpp"

namespace roadstereo::cli {

/// The output folder of a flight. One program at a time writes into it.
class FlightFolder {
 public:
  /// Makes it, locks it, and clears away what a killed run left half written. Throws Error when another program writes
  /// into it.
  explicit FlightFolder(const std::filesystem::path& folder);
  FlightFolder(const FlightFolder&) = delete;
  FlightFolder& operator=(const FlightFolder&) = delete;
  ~FlightFolder();

  std::filesystem::path journal() const;
  const std::filesystem::path& path() const { return files_.path(); }

  /// Removes what an earlier flight wrote, frame by frame, before another begins in its place.
  void remove_earlier_flight();

  /// Writes the files of a frame, each whole.
  void write(const std::vector<StagedFile>& files);

  /// The content of a file, or nothing when there is none.
  std::vector<std::uint8_t> read(const std::string& name) const;

 private:
  int lock_ = -1;
  std::vector<std::filesystem::path> before_;  ///< staging folders that were there before this one's
  io::OutputFolder files_;
};

/// Name of the small picture of a frame, when that frame of the flight is to have one: of 17 to 32 frames, evenly
/// spaced, however long the flight becomes.
std::optional<std::string> thumbnail_name(std::int64_t place);

/// Whether that frame is among the evenly spaced ones of a flight of `frames`.
bool is_shown(std::int64_t place, std::int64_t frames);

/// Name of the picture of a damage of the road.
std::string damage_picture_name(std::int64_t road_damage);

}  // namespace roadstereo::cli
