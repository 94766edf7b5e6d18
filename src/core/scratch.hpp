#pragma once

#include <memory_resource>
#include <vector>

#pragma GCC visibility push(default)
namespace roadstereo {

/// Sets the memory resource of the scratch vectors of this thread until it goes out of scope: a pool that a pipeline
/// keeps from frame to frame, so that they allocate nothing once every size has occurred.
class ScratchScope {
 public:
  explicit ScratchScope(std::pmr::memory_resource& memory);
  ~ScratchScope();
  ScratchScope(const ScratchScope&) = delete;
  ScratchScope& operator=(const ScratchScope&) = delete;

  /// Returns the resource of this thread; the heap outside every scope.
  static std::pmr::memory_resource* memory();

 private:
  std::pmr::memory_resource* previous_;
};

/// Vector of scratch memory, which must not outlive the frame: `ScratchVector<T> v = scratch_vector<T>();`
template <class T>
using ScratchVector = std::pmr::vector<T>;

template <class T>
ScratchVector<T> scratch_vector(std::size_t size = 0, const T& value = T{}) {
  return ScratchVector<T>(size, value, ScratchScope::memory());
}

}  // namespace roadstereo
#pragma GCC visibility pop
