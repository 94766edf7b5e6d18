#include "flight/flight_folder.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
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

int lock_folder(const fs::path& folder) {
  constexpr mode_t readable = 0644;
  const fs::path file = folder / "lock";
  const int descriptor = ::open(file.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, readable);
  if (descriptor < 0) {
    fail("cannot write to folder ", folder.string(), ": ", std::generic_category().message(errno));
  }
  if (::flock(descriptor, LOCK_EX | LOCK_NB) == 0) return descriptor;
  const int error = errno;
  ::close(descriptor);
  if (error == EWOULDBLOCK) fail(folder.parent_path().string(), ": another process is writing to this folder");
  fail<SystemError>("cannot lock ", file.string(), ": ", std::generic_category().message(error));
}

/// What a flight writes besides the files of its frames, its track and its trajectory.
constexpr std::array flight_files = {
    "frames.csv",   "pose.csv",    "damages.csv",       "candidates.csv",  "sightings.csv",
    "summary.json", "report.html", static_mask_file,    "rig_bias.json",   "flight.mcap",
    "damages",      "map",         "flight/thumbnails", "flight/sections", "flight/journal.jsonl"};

/// What is written with --track.
constexpr std::array track_files = {"segments.csv",      "frames.geojson",     "footprints.geojson", "damages.geojson",
                                    "sightings.geojson", "candidates.geojson", "flight.gpkg"};

}  // namespace

FlightFolder::FlightFolder(const fs::path& folder) : files_(folder) {
  const fs::path own = folder / "flight";
  std::error_code error;
  fs::create_directories(own, error);
  if (error) fail("cannot write to folder ", own.string(), ": ", error.message());
  lock_ = lock_folder(own);
}

FlightFolder::~FlightFolder() {
  if (lock_ >= 0) ::close(lock_);
}

fs::path FlightFolder::journal() const {
  return path() / "flight" / "journal.jsonl";
}

void FlightFolder::protect(const fs::path& input) {
  std::error_code absent;
  const auto require_other = [&](const char* name) {
    const fs::path below = fs::relative(input, path() / name, absent);  // of a folder that is removed
    const bool is_removed = !below.empty() && *below.begin() != "..";
    if (!is_removed && !fs::equivalent(path() / name, input, absent)) return;
    fail(input.string(), ": this input would be overwritten; choose another output folder");
  };
  std::for_each(flight_files.begin(), flight_files.end(), require_other);
  std::for_each(track_files.begin(), track_files.end(), require_other);
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
  remove_track_files();
  remove_trajectory_files();
}

void FlightFolder::remove_track_files() {
  std::error_code ignored;
  for (const char* name : track_files) fs::remove(path() / name, ignored);
}

void FlightFolder::remove_trajectory_files() {
  std::error_code ignored;
  for (const std::string& name : trajectory_file_names()) fs::remove(path() / name, ignored);
}

void FlightFolder::write(const std::vector<StagedFile>& files) {
  if (files.empty()) return;
  for (const StagedFile& file : files) files_.add(file.name, file.bytes);
  files_.commit();
}

std::vector<std::uint8_t> FlightFolder::read(const std::string& name) const {
  std::ifstream file(path() / name, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

bool is_flight_folder(const fs::path& folder) {
  std::error_code absent;
  return fs::exists(folder / "flight" / "journal.jsonl", absent);
}

bool is_pair_folder(const fs::path& folder) {
  std::error_code absent;
  return fs::exists(folder / "result.json", absent);
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
