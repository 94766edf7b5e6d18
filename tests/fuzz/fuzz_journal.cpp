// A line of a flight's journal: read, written and read again.
#include <cstdint>
#include <string>

#include "roadstereo/error.hpp"
#include "roadstereo/io/flight_frame.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace roadstereo;
  const std::string line(data, data + size);
  io::FlightFrame frame;
  try {
    frame = io::read_flight_frame(line);
  } catch (const Error&) {
    return 0;
  }
  const std::string written = io::flight_frame_json(frame);
  if (io::flight_frame_json(io::read_flight_frame(written)) != written) __builtin_trap();
  return 0;
}
