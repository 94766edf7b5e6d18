#pragma once

namespace roadstereo::bench {

/// Times the kernels of one frame each by itself and prints them beside the least that their bytes and operations cost on
/// this GPU (counted at the head of every .cu file).
void time_kernels(int width, int height, int disparities, int runs);

}  // namespace roadstereo::bench
