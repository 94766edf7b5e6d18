#pragma once

#include <vector>

#include "synth/height_field.hpp"

namespace roadstereo::synth {

/// Measure every damage by numerical integration over the height field, on a grid much finer than any image of it.
/// Where damages overlap, a point counts for the first of them, as in the labels, with the depth of all of them
/// together.
std::vector<DamageTruth> measure_damages(const HeightField& field, const Road& road, int threads);

}  // namespace roadstereo::synth
