#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

namespace roadstereo::cli {

/// Writes a file that appears whole or not at all: beside its place, then renamed. Throws SystemError naming it.
void write_whole_file(const std::filesystem::path& path, std::span<const std::uint8_t> bytes);

}  // namespace roadstereo::cli
