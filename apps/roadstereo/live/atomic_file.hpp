#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

namespace roadstereo::cli {

/// Writes a file atomically: to a temporary file that is then renamed. Throws SystemError naming it.
void write_file_atomically(const std::filesystem::path& path, std::span<const std::uint8_t> bytes);

}  // namespace roadstereo::cli
