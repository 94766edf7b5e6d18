#include "allocation_count.hpp"

#include <cstdlib>

#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

#include <malloc.h>

#include <atomic>
#include <cerrno>

// The functions of glibc under the names that remain if malloc and the others are replaced.
extern "C" {
void* __libc_malloc(std::size_t);                 // NOLINT(bugprone-reserved-identifier)
void* __libc_calloc(std::size_t, std::size_t);    // NOLINT(bugprone-reserved-identifier)
void* __libc_realloc(void*, std::size_t);         // NOLINT(bugprone-reserved-identifier)
void* __libc_memalign(std::size_t, std::size_t);  // NOLINT(bugprone-reserved-identifier)
void __libc_free(void*);                          // NOLINT(bugprone-reserved-identifier)
}

namespace {

std::atomic<std::size_t> calls{0};
std::atomic<std::size_t> live{0};
std::atomic<std::size_t> peak{0};

void* count(void* block) {
  if (block == nullptr) return block;
  ++calls;
  const std::size_t now = live += malloc_usable_size(block);
  std::size_t highest = peak;
  while (now > highest && !peak.compare_exchange_weak(highest, now)) {
  }
  return block;
}

void forget(void* block) {
  if (block != nullptr) live -= malloc_usable_size(block);
}

}  // namespace

extern "C" {
void* malloc(std::size_t size) noexcept {
  return count(__libc_malloc(size));
}
void* calloc(std::size_t number, std::size_t size) noexcept {
  return count(__libc_calloc(number, size));
}
void* realloc(void* block, std::size_t size) noexcept {
  forget(block);
  return count(__libc_realloc(block, size));
}
void* memalign(std::size_t alignment, std::size_t size) noexcept {
  return count(__libc_memalign(alignment, size));
}
void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  return count(__libc_memalign(alignment, size));
}
int posix_memalign(void** block, std::size_t alignment, std::size_t size) noexcept {
  void* made = count(__libc_memalign(alignment, size));
  if (made == nullptr) return ENOMEM;
  *block = made;
  return 0;
}
void free(void* block) noexcept {
  forget(block);
  __libc_free(block);
}
}

namespace roadstereo {

std::optional<Allocations> allocations() {
  return Allocations{calls, live, peak};
}

void reset_peak() {
  peak = live.load();
}

}  // namespace roadstereo

#else

namespace roadstereo {

std::optional<Allocations> allocations() {
  return std::nullopt;
}

void reset_peak() {}

}  // namespace roadstereo

#endif
