#include "flight/flight_folder.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <system_error>

#include "auto_mask.hpp"
#include "flight/flight_trajectory.hpp"
#include "flight/frame_files.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/io/flight_journal.hpp"

namespace roadstereo::cli {
namespace fs = std::filesystem;

namespace {

constexpr std::int64_t max_thumbnails = 32;

/// Interval of thumbnails in a flight with frames up to `sequence`.
std::int64_t thumbnail_step(std::int64_t sequence) {
  std::int64_t step = 1;
  while (sequence >= step * max_thumbnails) step *= 2;
  return step;
}

/// What a flight writes besides the files of its frames and `optional_files`.
constexpr std::array flight_files = {
    "frames.csv",   "pose.csv",          "damages.csv",     "candidates.csv",      "sightings.csv",
    "summary.json", "report.html",       static_mask_file,  "flight.mcap",         "damages",
    "map",          "flight/thumbnails", "flight/sections", "flight/journal.jsonl"};

/// What the end of a run writes or not: with --track and --trajectory, and where the rig has a bias.
std::vector<std::string> optional_files() {
  std::vector<std::string> names{"segments.csv",      "frames.geojson",     "footprints.geojson", "damages.geojson",
                                 "sightings.geojson", "candidates.geojson", "flight.gpkg",        "rig_bias.json"};
  const std::vector<std::string>& trajectory = trajectory_file_names();
  names.insert(names.end(), trajectory.begin(), trajectory.end());
  return names;
}

}  // namespace

FlightFolder::FlightFolder(const fs::path& folder) : files_(folder) {
  const fs::path own = folder / "flight";
  std::error_code error;
  fs::create_directories(own, error);
  if (error) fail("cannot write to folder ", own.string(), ": ", error.message());
  lock_.emplace(folder, own / "lock");
}

fs::path FlightFolder::journal() const {
  return path() / "flight" / "journal.jsonl";
}

void FlightFolder::protect(const fs::path& input) {
  std::error_code absent;
  const auto require_other = [&](const fs::path& name) {
    const fs::path below = fs::relative(input, path() / name, absent);  // of a folder that is removed
    const bool is_removed = !below.empty() && *below.begin() != "..";
    if (!is_removed && !fs::equivalent(path() / name, input, absent)) return;
    fail(input.string(), ": this input would be overwritten; choose another output folder");
  };
  std::for_each(flight_files.begin(), flight_files.end(), require_other);
  const std::vector<std::string> optional = optional_files();
  std::for_each(optional.begin(), optional.end(), require_other);
  files_.protect(input);
}

void FlightFolder::remove_earlier_flight() {
  std::error_code ignored;
  if (!fs::exists(journal(), ignored)) return;
  try {
    io::read_flight_journal(journal(), [&](const io::FlightFrame& frame) {
      for (const std::string& name : frame_file_names(frame.index)) fs::remove(path() / name, ignored);
    });
  } catch (const Error&) {  // an unreadable journal lists no files
  }
  for (const char* name : flight_files) {
    fs::remove_all(path() / name, ignored);
  }
  for (const std::string& name : optional_files()) fs::remove(path() / name, ignored);
}

void FlightFolder::remove_unwritten() {
  std::error_code ignored;
  for (const std::string& name : optional_files()) {
    if (written_.count(name) == 0) fs::remove(path() / name, ignored);
  }
}

void FlightFolder::write(const std::vector<StagedFile>& files) {
  if (files.empty()) return;
  for (const StagedFile& file : files) files_.add(file.name, file.bytes);
  files_.commit();
  for (const StagedFile& file : files) written_.insert(file.name);
}

std::vector<std::uint8_t> FlightFolder::read(const std::string& name) const {
  std::ifstream file(path() / name, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

std::optional<std::string> thumbnail_name(std::int64_t sequence) {
  if (sequence % thumbnail_step(sequence) != 0) return std::nullopt;
  return fmt::format("flight/thumbnails/{:06}.jpg", sequence);
}

bool is_shown(std::int64_t sequence, std::int64_t frames) {
  return sequence % thumbnail_step(frames - 1) == 0;
}

std::string damage_picture_name(std::int64_t road_damage) {
  return fmt::format("damages/{:05}.jpg", road_damage);
}

std::string damage_section_name(std::int64_t road_damage) {
  return fmt::format("flight/sections/{:05}.html", road_damage);
}

}  // namespace roadstereo::cli
