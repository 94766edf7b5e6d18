#pragma once

#include <string_view>

/// Templates of the flight report, embedded from this folder at build time. Templates of both reports are in
/// io/report/templates.hpp.
namespace roadstereo::io::flight_templates {

extern const std::string_view document;  ///< flight.html
extern const std::string_view map;       ///< map.svg: the way of the camera with the damages
extern const std::string_view style;     ///< flight.css: additions to report.css

}  // namespace roadstereo::io::flight_templates
