#pragma once

#include <filesystem>

#include "map/map_plan.hpp"

namespace roadstereo::cli {

/// A recording, its poses and options as `inspect --trajectory` or `--map` left them in its output folder. Throws Error
/// if the run is not finished, has no trajectory, or its recording is gone.
MapPass read_run(const std::filesystem::path& folder);

}  // namespace roadstereo::cli
