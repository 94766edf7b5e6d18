#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "io/ros/flight_messages.hpp"
#include "roadstereo/io/flight_frame.hpp"
#include "roadstereo/io/frame_source.hpp"
#include "roadstereo/pipeline.hpp"

namespace roadstereo::cli {

/// A file to be written.
struct StagedFile {
  std::string name;
  std::vector<std::uint8_t> bytes;
};

inline StagedFile text_file(const std::string& name, const std::string& text) {
  return {name, {text.begin(), text.end()}};
}

/// One frame in the flight pipeline. Jobs are reused to avoid allocations.
struct FlightJob {
  std::int64_t sequence = 0;  ///< number of the frame in the flight, from 0
  io::SourcePair pair;
  io::FlightFrame frame;
  FrameResult result;
  DamageMap damage;
  std::vector<StagedFile> files;
  std::optional<io::RosPose> pose;       ///< with a trajectory
  std::vector<std::uint8_t> mcap_chunk;  ///< of flight.mcap; empty: none
};

}  // namespace roadstereo::cli
