#pragma once

#include <filesystem>
#include <string>

#include "inspection.hpp"

namespace roadstereo::cli {

/// What the terminal shows of one inspected pair: one screen.
std::string summary(const Inspection& inspection, const std::filesystem::path& folder);

}  // namespace roadstereo::cli
