#pragma once

#include <fmt/core.h>

#include <cstdio>
#include <string>
#include <utility>

namespace roadstereo::cli {

/// Prints to standard error. Write errors, e.g. of a closed terminal, are ignored.
template <class... Values>
void log_stderr(fmt::format_string<Values...> text, Values&&... values) {
  std::fputs(fmt::format(text, std::forward<Values>(values)...).c_str(), stderr);
  std::fflush(stderr);
}

}  // namespace roadstereo::cli
