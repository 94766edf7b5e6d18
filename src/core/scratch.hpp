#pragma once

#include <memory_resource>
#include <vector>

namespace roadstereo {

/// Memory that a pipeline keeps from frame to frame, so that the short-lived vectors of its stages allocate nothing
/// once every size has been seen. In force on the thread that made it, until it goes out of scope.
class ScratchScope {
 public:
  explicit ScratchScope(std::pmr::memory_resource& memory);
  ~ScratchScope();
  ScratchScope(const ScratchScope&) = delete;
  ScratchScope& operator=(const ScratchScope&) = delete;

  /// The memory in force on this thread; the heap outside every scope.
  static std::pmr::memory_resource* memory();

 private:
  std::pmr::memory_resource* previous_;
};

/// A vector that must not outlive the frame: `ScratchVector<T> v = scratch_vector<T>();`
template <class T>
using ScratchVector = std::pmr::vector<T>;

template <class T>
ScratchVector<T> scratch_vector(std::size_t size = 0, const T& value = T{}) {
  return ScratchVector<T>(size, value, ScratchScope::memory());
}

}  // namespace roadstereo
