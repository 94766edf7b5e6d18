// A track as text: CSV, NMEA or subtitles.
#include <cstdint>
#include <string>

#include "io/geo/track_formats.hpp"
#include "roadstereo/error.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace roadstereo;
  const io::TrackText file{"track", std::string(data, data + size)};
  for (const auto& read : {io::read_track_csv, io::read_nmea, io::read_srt}) {
    try {
      (void)read(file);
    } catch (const Error&) {
    }
  }
  return 0;
}
