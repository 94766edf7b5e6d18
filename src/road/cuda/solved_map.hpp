#pragma once

#include "road/raw_sums.hpp"
#include "road/roll_energy.hpp"

namespace roadstereo::cuda {

/// What MapSums leaves for the host. The plane comes first, so that its address serves as a PlaneSource.
struct SolvedMap {
  SolvedRoll roll;
  RawSums sums;
};

}  // namespace roadstereo::cuda
