#pragma once

#include "core/function_ref.hpp"

#pragma GCC visibility push(default)
namespace roadstereo {

/// Returns the number of worker threads: `threads`, or all cores for 0; with oneTBB at most all cores. Throws Error
/// when negative or above 1024.
int resolve_threads(int threads);

/// Calls `body(i, worker)` for every i in [0, count), on up to `threads` threads (0: all cores). `worker` numbers the
/// threads from 0, below resolve_threads(threads): two calls that run at the same time have different workers, so that
/// each can own scratch memory. Which worker takes which i is not fixed. The first exception thrown by a body is
/// rethrown.
void parallel_for(int count, int threads, FunctionRef<void(int, int)> body);

/// Calls `body(first, last, worker)` on bands of `rows_per_band` rows of [0, rows).
void parallel_rows(int rows, int rows_per_band, int threads, FunctionRef<void(int, int, int)> body);

}  // namespace roadstereo
#pragma GCC visibility pop
