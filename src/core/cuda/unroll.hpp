#pragma once

// Before a loop whose body indexes an array: straight code, so that the array lies in registers. Or the opposite,
// before one that would take registers from what runs more often.
#if defined(__CUDACC__)
#define ROADSTEREO_UNROLL _Pragma("unroll")
#define ROADSTEREO_DO_NOT_UNROLL _Pragma("unroll 1")
#else
#define ROADSTEREO_UNROLL
#define ROADSTEREO_DO_NOT_UNROLL
#endif
