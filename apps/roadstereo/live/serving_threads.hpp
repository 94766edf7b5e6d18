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

/// The server's threads: one for each connection that is being served, made when it is needed, up to a limit; further
/// connections wait. They give way to the threads that make the views.
class ServingThreads final : public httplib::TaskQueue {
 public:
  explicit ServingThreads(std::size_t most) : most_(most) {}

  /// What the library's version wants returned: nothing, or that the task was taken.
  using Taken = decltype(std::declval<httplib::TaskQueue&>().enqueue({}));

  Taken enqueue(std::function<void()> task) override;
  void shutdown() override;

 private:
  void serve();

  std::size_t most_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> tasks_;
  std::vector<std::thread> threads_;
  std::size_t idle_ = 0;
  bool closing_ = false;
};

}  // namespace roadstereo::cli
