#pragma once

#include "roadstereo/synth.hpp"

namespace roadstereo::synth {

/// Whether a pixel lies on the bonnet: a parabola over the lower border. `view`: 0 for the left image, 1 for the right.
bool is_bonnet(const Scene& scene, int view, double u, double v);

/// Draw what stands between the camera and the road: the bonnet, seen by both cameras, and snowflakes, each seen by
/// one.
void cover_lens(const Scene& scene, int view, Image<float>& irradiance);

}  // namespace roadstereo::synth
