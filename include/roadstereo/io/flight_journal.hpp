#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "roadstereo/io/flight_frame.hpp"

namespace roadstereo::io {

/// What a flight was made with, as names and values; a flight goes on only with the same.
using Provenance = std::vector<std::pair<std::string, std::string>>;

/// The record of a flight while it is made: a text file with one line a frame, appended as frames are done. A line
/// that a kill cut short is left out and written again.
class FlightJournal {
 public:
  /// Begins a journal; an earlier one is replaced. Throws SystemError when the file cannot be written.
  static FlightJournal begin(const std::filesystem::path& file, const Provenance& facts);

  /// Goes on with one. Throws Error when there is none, or when it was begun with other facts: the sentence names the
  /// first that differs.
  static FlightJournal resume(const std::filesystem::path& file, const Provenance& facts);

  FlightJournal(FlightJournal&& other) noexcept;
  FlightJournal& operator=(FlightJournal&&) = delete;
  ~FlightJournal();

  /// Appends a frame; once this returns, the frame outlives a kill. Throws SystemError on a full disk.
  void append(const FlightFrame& frame);

  std::int64_t frames() const { return frames_; }

  /// The last frame that was appended, by this run or an earlier one.
  const std::optional<FlightFrame>& last() const { return last_; }

  /// Reads the frames from first to last, one at a time.
  void for_each(const std::function<void(const FlightFrame&)>& visit) const;

 private:
  FlightJournal(std::filesystem::path file, int descriptor);
  void write_line(const std::string& line);

  std::filesystem::path file_;
  int descriptor_ = -1;
  std::int64_t frames_ = 0;
  std::optional<FlightFrame> last_;
};

/// Every frame of a journal, one at a time. Throws Error when there is none.
void read_flight_journal(const std::filesystem::path& file, const std::function<void(const FlightFrame&)>& visit);

}  // namespace roadstereo::io
