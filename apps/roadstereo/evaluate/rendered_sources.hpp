#pragma once

#include "evaluate/robustness_sources.hpp"

namespace roadstereo::cli {

/// Random degraded roads with the seeds 1 … `count`, rendered when they are read.
LabelledSource rendered_roads(int count, int threads);

/// Streets between a row of parked cars and a house front, likewise: the road fills a small part of the picture, which
/// is noisy, out of focus or of low contrast.
LabelledSource rendered_streets(int count, int threads);

/// Random scenes of the widest kind (synth::random_wide_scene), likewise, with their JPEG loss.
LabelledSource rendered_wide_scenes(int count, int threads);

}  // namespace roadstereo::cli
