#pragma once

// Formulas that kernels and the host share. Headers that use this are C++17, the most that CUDA 11 takes.
#if defined(__CUDACC__)
#define ROADSTEREO_HD __host__ __device__
#else
#define ROADSTEREO_HD
#endif
