#pragma once

// Before a loop whose body indexes an array: straight code, so that the array lies in registers.
#if defined(__CUDACC__)
#define ROADSTEREO_UNROLL _Pragma("unroll")
#else
#define ROADSTEREO_UNROLL
#endif
