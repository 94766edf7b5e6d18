#pragma once

#include <httplib.h>

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace roadstereo::cli {

/// Thread pool of the server: one low-priority thread per connection, created on demand up to a limit; further
/// connections wait.
class ServingThreads final : public httplib::TaskQueue {
 public:
  explicit ServingThreads(std::size_t max_threads) : max_threads_(max_threads) {}

  /// Return type of the version of httplib: void, or bool (task accepted).
  using Taken = decltype(std::declval<httplib::TaskQueue&>().enqueue({}));

  Taken enqueue(std::function<void()> task) override;
  void shutdown() override;

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
