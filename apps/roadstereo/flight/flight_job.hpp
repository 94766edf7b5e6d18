#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "roadstereo/io/flight_frame.hpp"
#include "roadstereo/io/frame_source.hpp"
#include "roadstereo/pipeline.hpp"

namespace roadstereo::cli {

/// A file that waits to be written.
struct StagedFile {
  std::string name;
  std::vector<std::uint8_t> bytes;
};

inline StagedFile text_file(const std::string& name, const std::string& text) {
  return {name, {text.begin(), text.end()}};
}

/// One frame on its way through the program. Its memory serves one frame after the other.
struct FlightJob {
  std::int64_t place = 0;  ///< which frame of the flight, from 0, whatever its place in the source
  io::SourcePair pair;
  io::FlightFrame frame;
  FrameResult result;
  DamageMap damage;
  std::vector<StagedFile> files;
};

}  // namespace roadstereo::cli
