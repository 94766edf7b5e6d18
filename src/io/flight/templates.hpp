#pragma once

#include <string_view>

/// The files of this folder that a flight's report is put together from, embedded when the library is built. What both
/// kinds of report share is in io/report/templates.hpp.
namespace roadstereo::io::flight_templates {

extern const std::string_view document;  ///< flight.html
extern const std::string_view style;     ///< flight.css: what report.css does not have

}  // namespace roadstereo::io::flight_templates
