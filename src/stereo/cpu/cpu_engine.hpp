#pragma once

#include <memory>
#include <string>

#include "roadstereo/matcher.hpp"

namespace roadstereo {

/// Section 3.2 of the paper in one pass over tiles: sliding sums for the correlation, a ring of cost rows instead of a
/// volume, the disparities of a pixel as vectors, threads over tiles.
std::unique_ptr<StereoEngine> make_cpu_engine(int threads);

/// The instruction set that the engine's kernels use on this machine, e.g. "AVX3".
std::string cpu_engine_target();

}  // namespace roadstereo
