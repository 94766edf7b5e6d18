#include "core/parallel.hpp"

#include <algorithm>
#include <optional>
#include <thread>

#include "roadstereo/error.hpp"

#ifdef ROADSTEREO_WITH_TBB
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#else
#include <atomic>
#include <exception>
#include <mutex>
#include <vector>
#endif

namespace roadstereo {

#ifdef ROADSTEREO_WITH_TBB
namespace {

/// The arena that this thread last used; making one for every call would allocate.
tbb::task_arena& arena_of(int threads) {
  thread_local std::optional<tbb::task_arena> arena;
  if (!arena || arena->max_concurrency() != threads) arena.emplace(threads);
  return *arena;
}

}  // namespace
#endif

int resolve_threads(int threads) {
  if (threads < 0 || threads > 1024) fail("threads is ", threads, "; it must be between 0 (all cores) and 1024");
#ifdef ROADSTEREO_WITH_TBB
  // More threads than cores gain nothing, cost memory each, and TBB complains about them on stderr.
  static const int cores = tbb::info::default_concurrency();  // reads files of the system: once
  return threads > 0 ? std::min(threads, cores) : cores;
#else
  static const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));  // likewise
  return threads > 0 ? threads : cores;
#endif
}

void parallel_for(int count, int threads, FunctionRef<void(int, int)> body) {
  const int available = resolve_threads(threads), workers = std::min(available, count);
  if (workers <= 1) {
    for (int i = 0; i < count; ++i) body(i, 0);
    return;
  }
#ifdef ROADSTEREO_WITH_TBB
  const auto run = [&] {
    tbb::parallel_for(
        tbb::blocked_range<int>(0, count, 1),
        [&](const tbb::blocked_range<int>& range) {
          const int worker = tbb::this_task_arena::current_thread_index();
          for (int i = range.begin(); i < range.end(); ++i) body(i, worker);
        },
        tbb::simple_partitioner{});
  };
  arena_of(available).execute(run);  // of one size whatever the count, so that it is kept
#else
  std::atomic<int> next{0};
  std::exception_ptr first_error;
  std::mutex error_mutex;
  const auto work = [&](int worker) {
    for (int i = next++; i < count; i = next++) {
      try {
        body(i, worker);
      } catch (...) {
        const std::scoped_lock lock(error_mutex);
        if (!first_error) first_error = std::current_exception();
        next = count;
      }
    }
  };
  {
    std::vector<std::jthread> pool;
    for (int t = 1; t < workers; ++t) pool.emplace_back(work, t);
    work(0);
  }
  if (first_error) std::rethrow_exception(first_error);
#endif
}

void parallel_rows(int rows, int rows_per_band, int threads, FunctionRef<void(int, int, int)> body) {
  const int bands = (rows + rows_per_band - 1) / rows_per_band;
  parallel_for(bands, threads, [&](int band, int worker) {
    body(band * rows_per_band, std::min(rows, (band + 1) * rows_per_band), worker);
  });
}

}  // namespace roadstereo
