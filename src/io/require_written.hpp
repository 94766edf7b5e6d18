#pragma once

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "roadstereo/error.hpp"

namespace roadstereo::io {

/// Throws SystemError with the file and the system's message if the stream could not be opened or written. Called at
/// once: a later call of the system may replace its message.
inline void require_written(const std::ofstream& stream, const std::filesystem::path& file) {
  const int cause = errno;
  if (!stream) fail<SystemError>(file.string(), ": cannot be written: ", std::generic_category().message(cause));
}

}  // namespace roadstereo::io
