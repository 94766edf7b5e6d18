#include "live/recording_folder.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <iterator>
#include <system_error>
#include <utility>

#include "live/atomic_file.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/io/image_file.hpp"

namespace roadstereo::cli {
namespace fs = std::filesystem;
namespace {

constexpr int png_level = 1;  // fast

std::span<const std::uint8_t> bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) fail("cannot record to ", folder.string(), ": ", error.message());
}

void require_no_recording(const fs::path& folder, const std::string& calibration) {
  std::error_code ignored;
  for (const char* name : {"left", "right", "times.txt"}) {
    if (fs::exists(folder / name, ignored)) {
      fail("cannot record to ", folder.string(), ": it already contains ", name, "; --record needs a new folder");
    }
  }
  const fs::path file = folder / "calibration.yaml";
  if (calibration.empty() || !fs::exists(file, ignored)) return;
  std::ifstream stream(file, std::ios::binary);
  const std::string present{std::istreambuf_iterator<char>(stream), {}};
  if (present != calibration) {
    fail("cannot record to ", folder.string(), ": it already contains another calibration.yaml; --record needs a new ",
         "folder");
  }
}

}  // namespace

RecordingFolder::RecordingFolder(fs::path folder, const std::string& calibration) : folder_(std::move(folder)) {
  require_no_recording(folder_, calibration);
  try {
    create(calibration);
  } catch (...) {
    remove_empty();
    throw;
  }
}

void RecordingFolder::create(const std::string& calibration) {
  make_folder(folder_ / "left");
  make_folder(folder_ / "right");
  const fs::path file = folder_ / "calibration.yaml";
  wrote_calibration_ = !calibration.empty() && !fs::exists(file);
  if (wrote_calibration_) write_file_atomically(file, bytes_of(calibration));
  const fs::path times = folder_ / "times.txt";
  times_ = ::open(times.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_APPEND | O_CLOEXEC, 0666);
  if (times_ < 0) fail("cannot write ", times.string(), ": ", std::generic_category().message(errno));
}

RecordingFolder::~RecordingFolder() {
  ::close(times_);
  if (pairs_ == 0) remove_empty();
}

/// Nothing was recorded: the folder can be reused.
void RecordingFolder::remove_empty() const {
  std::error_code ignored;
  if (times_ >= 0) fs::remove(folder_ / "times.txt", ignored);
  for (const char* name : {"left", "right"}) fs::remove(folder_ / name, ignored);
  if (wrote_calibration_) fs::remove(folder_ / "calibration.yaml", ignored);
}

/// Writes a line atomically, too.
void RecordingFolder::write_time(double time_s) {
  const std::string line = fmt::format("{:.6f}\n", time_s);
  const off_t before = ::lseek(times_, 0, SEEK_END);
  const ssize_t written = ::write(times_, line.data(), line.size());
  if (written == static_cast<ssize_t>(line.size())) return;
  const int error = written < 0 ? errno : ENOSPC;
  (void)!::ftruncate(times_, before);
  fail<SystemError>("cannot write ", (folder_ / "times.txt").string(), ": ", std::generic_category().message(error));
}

void RecordingFolder::write(const RecordedPair& pair) {
  const std::string name = fmt::format("{:06}.png", pairs_);
  const fs::path left = folder_ / "left" / name;
  const fs::path right = folder_ / "right" / name;
  try {
    write_file_atomically(left, io::encode_png(pair.left.view(), png_level));
    write_file_atomically(right, io::encode_png(pair.right.view(), png_level));
    write_time(pair.time_s);
  } catch (...) {
    std::error_code ignored;
    fs::remove(left, ignored);
    fs::remove(right, ignored);
    throw;
  }
  ++pairs_;
  save_now_and_then();
}

/// A vehicle is switched off without a word: what is older than a second is on the disk.
void RecordingFolder::save_now_and_then() {
  constexpr double period_s = 1;
  const Clock::time_point now = Clock::now();
  if (seconds_between(saved_, now) < period_s) return;
  ::syncfs(times_);  // the images, too
  saved_ = Clock::now();
}

}  // namespace roadstereo::cli
