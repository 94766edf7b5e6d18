#pragma once

#include <cstdint>
#include <optional>

#include "flight/flight_folder.hpp"
#include "flight/flight_settings.hpp"
#include "flight/progress.hpp"
#include "flight/rectified_source.hpp"
#include "roadstereo/io/flight_inventory.hpp"
#include "roadstereo/io/flight_journal.hpp"
#include "stop_signals.hpp"

namespace roadstereo::cli {

/// A flight on its way through the program.
struct Flight {
  RectifiedSource& source;
  FlightFolder& folder;
  io::FlightJournal& journal;
  io::FlightInventory& inventory;  ///< of the frames that the journal has
  PipelineOptions options;
  Progress& progress;
  const StopSignals& stop;
};

/// Processes the frames that the journal does not have yet: one thread reads, one matches (with the threads of the
/// options), others find damage and encode, and all is written in order. No frame is dropped. Returns whether the end
/// was reached; false after Ctrl-C, when the frames in flight have been finished.
bool run_flight(const FlightSettings& settings, Flight& flight);

}  // namespace roadstereo::cli
