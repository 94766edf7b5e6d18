#pragma once

#include <sstream>
#include <string>

namespace roadstereo {

/// Concatenates the parts, numbers with three digits: for reasons and warnings.
template <class... Parts>
std::string format_message(const Parts&... parts) {
  std::ostringstream text;
  text.precision(3);
  (text << ... << parts);
  return text.str();
}

}  // namespace roadstereo
