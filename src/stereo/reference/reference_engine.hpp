#pragma once

#include <memory>

#include "roadstereo/matcher.hpp"

namespace roadstereo {

/// Section 3.2 of the paper as written, in double precision: slow, the oracle of every other engine.
std::unique_ptr<StereoEngine> make_reference_engine(int threads);

}  // namespace roadstereo
