#pragma once

// Marks functions that CUDA kernels call too. Headers that use it are C++17, the latest standard of CUDA 11.
#if defined(__CUDACC__)
#define ROADSTEREO_HD __host__ __device__
#else
#define ROADSTEREO_HD
#endif
