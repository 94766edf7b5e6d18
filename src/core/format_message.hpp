#pragma once

#include <sstream>
#include <string>

namespace roadstereo {

/// The parts written one after the other, numbers with three digits: for reasons and warnings.
template <class... Parts>
std::string format_message(const Parts&... parts) {
  std::ostringstream text;
  text.precision(3);
  (text << ... << parts);
  return text.str();
}

}  // namespace roadstereo
