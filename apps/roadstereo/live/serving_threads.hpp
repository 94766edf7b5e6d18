#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace roadstereo::cli {

/// Thread pool of the server: low-priority threads, created on demand up to a limit; further tasks wait. An exception
/// of a task is ignored.
class ServingThreads {
 public:
  explicit ServingThreads(std::size_t max_threads) : max_threads_(max_threads) {}

  void enqueue(std::function<void()> task);

  /// Finishes all tasks and joins the threads. Call it before destruction.
  void shutdown();

 private:
  void serve();

  std::size_t max_threads_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> tasks_;
  std::vector<std::thread> threads_;
  std::size_t idle_ = 0;
  bool closing_ = false;
};

}  // namespace roadstereo::cli
