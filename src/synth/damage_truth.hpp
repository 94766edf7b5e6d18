#pragma once

#include <vector>

#include "synth/height_field.hpp"

namespace roadstereo::synth {

/// Measures every damage on the height field itself, on a grid much finer than any picture of it. Where
/// damages overlap a point counts for the first, as in the labels; its depth is that of all of them together.
std::vector<DamageTruth> measure_damages(const HeightField& field, const Road& road, int threads);

}  // namespace roadstereo::synth
