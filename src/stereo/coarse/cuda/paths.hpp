#pragma once

#include "core/cuda/stream.hpp"
#include "roadstereo/image_view.hpp"
#include "stereo/coarse/cuda/coarse_volume.hpp"
#include "stereo/coarse/path_winner.hpp"
#include "stereo/coarse/scanline.hpp"

// Scanline optimisation (1-D semi-global matching) on the device.

namespace roadstereo::cuda {

/// The pitch of volumes of so many disparities, at most 512.
int path_pitch(int disparities);

/// Takes for every column of the band's rows the disparity of the cheapest path along the row that passes through it
/// (stereo/coarse/scanline.hpp), coarse pixels, NaN where a column has no counterpart. `forward` and `backward` are
/// scratch memory of the size of `costs`, `roads` what these hold of the road.
void aggregate_scanlines(const CoarseVolume& costs, const ScanlinePenalties& penalties, ImageView<const RoadCost> roads,
                         const int* first_seen, const CoarseVolume& forward, const CoarseVolume& backward,
                         ImageView<float> disparity, StreamView stream);

}  // namespace roadstereo::cuda
