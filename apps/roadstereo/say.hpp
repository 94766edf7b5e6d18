#pragma once

#include <fmt/core.h>

#include <cstdio>
#include <string>
#include <utility>

namespace roadstereo::cli {

/// Writes to standard error. Nobody may be there to read it, after a lost connection for example: the work goes on.
template <class... Values>
void say(fmt::format_string<Values...> text, Values&&... values) {
  std::fputs(fmt::format(text, std::forward<Values>(values)...).c_str(), stderr);
  std::fflush(stderr);
}

}  // namespace roadstereo::cli
