// Rendered pairs as those of a recording.
#pragma once

#include "pair_source.hpp"
#include "roadstereo/synth.hpp"

namespace roadstereo::cli {

/// Render the scene, and compress the images as its degradation says (jpeg_quality).
synth::SyntheticPair render_recorded(const synth::Scene& scene, int threads = 0);

/// Images and calibration of a rendered pair.
StereoPair pair_of(const synth::SyntheticPair& rendered);

/// Exact disparities of a rendered pair in single precision, pixels; NaN for sky.
Image<float> exact_map(const synth::SyntheticPair& rendered);

}  // namespace roadstereo::cli
