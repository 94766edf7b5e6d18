#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "flight/flight_job.hpp"
#include "folder_lock.hpp"
#include "roadstereo/io/flight_inventory.hpp"
#include "roadstereo/io/output_folder.hpp"

namespace roadstereo::cli {

/// Output folder of a flight, locked for exclusive writing.
class FlightFolder {
 public:
  /// Creates and locks the folder. Throws Error if another process holds the lock.
  explicit FlightFolder(const std::filesystem::path& folder);

  std::filesystem::path journal() const;
  std::filesystem::path mcap() const { return path() / "flight.mcap"; }
  const std::filesystem::path& path() const { return files_.path(); }

  /// Names an input that must not be overwritten or removed. Throws Error if it is a file of an earlier flight here.
  void protect(const std::filesystem::path& input);

  /// Removes the files of an earlier flight.
  void remove_earlier_flight();

  /// Removes the tables, GIS files and trajectories of an earlier run of this flight that this one has not written.
  void remove_unwritten();

  /// Writes files atomically.
  void write(const std::vector<StagedFile>& files);

  /// Reads a file; empty if it is missing.
  std::vector<std::uint8_t> read(const std::string& name) const;

 private:
  std::optional<FolderLock> lock_;
  io::OutputFolder files_;
  std::set<std::string> written_;
};

/// Returns the file name of a frame's thumbnail, or nullopt if the frame has none. A flight of any length has 17 to 32
/// evenly spaced thumbnails.
std::optional<std::string> thumbnail_name(std::int64_t sequence);

/// Returns whether the thumbnail is in the report of a flight of `frames`.
bool is_shown(std::int64_t sequence, std::int64_t frames);

/// Returns the file name of the image of a road damage.
std::string damage_picture_name(std::int64_t road_damage);

/// Returns the file name of the section of a road damage in the report.
std::string damage_section_name(std::int64_t road_damage);

}  // namespace roadstereo::cli
