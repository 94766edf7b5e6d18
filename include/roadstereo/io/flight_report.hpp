#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "roadstereo/io/flight_inventory.hpp"

namespace roadstereo::io {

/// Figures of every frame of a flight, one beside the other; NaN where a frame has none.
struct FlightCurves {
  std::vector<double> time;      ///< seconds, or the frame's number where the source has no times
  bool in_seconds = false;       ///< what `time` is
  std::vector<double> roll_deg;  ///< ψ
  std::vector<double> height_m;  ///< over the road
  std::vector<double> sigma_d_px;
};

/// A picture with what stands below it.
struct CaptionedPicture {
  std::string caption;
  std::vector<std::uint8_t> jpeg;
};

/// A damage and the picture of it; the picture may be empty.
struct PicturedDamage {
  RoadDamage damage;
  std::vector<std::uint8_t> jpeg;
};

/// What is told about a whole flight.
struct FlightReportInput {
  std::string title;
  std::vector<std::pair<std::string, std::string>> facts;  ///< key figures: name, value with unit
  std::vector<std::string> notices;                        ///< what the reader must know: refused frames, a stop
  FlightCurves curves;
  std::vector<CaptionedPicture> strip;  ///< thumbnails in the order of the flight
  std::vector<PicturedDamage> worst;    ///< worst first
  std::size_t damages = 0;              ///< all of them, of which `worst` are shown
  bool metric = false;                  ///< whether there is a calibration
};

/// The report as one HTML file that needs nothing else: styles, scripts and pictures are inside.
std::string flight_report(const FlightReportInput& input);

}  // namespace roadstereo::io
