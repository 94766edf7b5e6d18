#pragma once

#include "map/map_plan.hpp"
#include "roadstereo/io/flight_journal.hpp"

namespace roadstereo::cli {

/// Returns the inputs and options that determine a map, with hashes of calibrations and trajectories. Throws Error
/// naming a file that cannot be read.
io::Provenance provenance(const MapPlan& plan);

}  // namespace roadstereo::cli
