#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "flight/flight_folder.hpp"
#include "flight/flight_settings.hpp"
#include "io/ros/mcap_writer.hpp"
#include "roadstereo/io/flight_journal.hpp"

namespace roadstereo::cli {

/// The frames of a flight on disk: its journal, and flight.mcap with --write mcap. An earlier flight in the folder
/// stays until the first frame of a new one is on record: what is wrong with the options shows before.
class FlightRecord {
 public:
  /// With --resume opens the journal in the folder, if there is one. Throws Error naming the first option that differs.
  /// `metric`: there is a calibration.
  FlightRecord(const FlightSettings& settings, const FlightPlan& plan, bool metric, FlightFolder& folder);

  /// Calls `visit` for the frames of an earlier run, in order.
  void for_each(const std::function<void(const io::FlightFrame&)>& visit) const;

  std::int64_t frames() const { return journal_ ? journal_->frames() : 0; }

  /// The last frame, of this run or an earlier one; nullopt without any.
  std::optional<io::FlightFrame> last() const { return journal_ ? journal_->last() : std::nullopt; }

  /// Opens the flight.mcap of a flight that goes on after so many good frames. Throws Error unless it has them.
  void resume_mcap(std::int64_t good);

  /// Removes an earlier flight and begins the files, unless they are open.
  void begin();

  /// Appends a frame and its chunk, which may be empty, after `begin`.
  void append(const io::FlightFrame& frame, std::span<const std::uint8_t> chunk);

  /// Completes flight.mcap.
  void finish();

 private:
  FlightFolder& folder_;
  io::Provenance made_with_;
  bool with_mcap_;
  std::vector<io::RosTopic> topics_;
  std::optional<io::FlightJournal> journal_;
  std::optional<io::McapWriter> mcap_;
};

}  // namespace roadstereo::cli
