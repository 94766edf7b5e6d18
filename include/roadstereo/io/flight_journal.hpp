#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "roadstereo/io/flight_frame.hpp"

#pragma GCC visibility push(default)
namespace roadstereo::io {

/// Inputs and options of a flight as names and values. A flight is resumed only with identical ones.
using Provenance = std::vector<std::pair<std::string, std::string>>;

/// Append-only journal of a flight: a text file with one line per finished frame. An incomplete last line, left by a
/// killed run, is ignored and overwritten.
class FlightJournal {
 public:
  /// Creates a journal; replaces an existing one. Throws SystemError if the file cannot be written.
  static FlightJournal begin(const std::filesystem::path& file, const Provenance& provenance);

  /// Opens an existing journal. Throws Error if there is none, or naming the first entry of `provenance` that differs,
  /// and SystemError if it cannot be read.
  static FlightJournal resume(const std::filesystem::path& file, const Provenance& provenance);

  FlightJournal(FlightJournal&& other) noexcept;
  FlightJournal& operator=(FlightJournal&&) = delete;
  ~FlightJournal();

  /// Appends a frame; it is on disk when this returns. Throws SystemError on a full disk.
  void append(const FlightFrame& frame);

  std::int64_t frames() const { return frames_; }

  /// The last frame, appended by this run or an earlier one.
  const std::optional<FlightFrame>& last() const { return last_; }

  /// Calls `visit` for every frame in order.
  void for_each(const std::function<void(const FlightFrame&)>& visit) const;

 private:
  FlightJournal(std::filesystem::path file, int descriptor);
  void write_line(const std::string& line);

  std::filesystem::path file_;
  int descriptor_ = -1;
  std::int64_t frames_ = 0;
  std::optional<FlightFrame> last_;
};

/// Calls `visit` for every frame of a journal in order. Throws Error if there is no journal, SystemError if it cannot
/// be read.
void read_flight_journal(const std::filesystem::path& file, const std::function<void(const FlightFrame&)>& visit);

}  // namespace roadstereo::io
#pragma GCC visibility pop
