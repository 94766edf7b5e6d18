#include "damage/kept_maps.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <mutex>
#include <new>
#include <utility>

namespace roadstereo {
namespace {

/// Free blocks by size: powers of two.
class KeptMemory final : public ImageMemory {
 public:
  ~KeptMemory() {
    for (Block* block : free_) {
      while (block != nullptr) ::operator delete(std::exchange(block, block->next), alignment);
    }
  }

  void* allocate(std::size_t bytes) override {
    const auto size = static_cast<std::size_t>(std::bit_width(std::max<std::size_t>(bytes, 1) - 1));
    {
      const std::scoped_lock lock(mutex_);
      if (Block* const block = free_[size]; block != nullptr) {
        free_[size] = block->next;
        return block + 1;
      }
    }
    void* const memory = ::operator new(sizeof(Block) + (std::size_t{1} << size), alignment);
    return ::new (memory) Block{size, nullptr} + 1;
  }

  void deallocate(void* memory) noexcept override {
    Block* const block = static_cast<Block*>(memory) - 1;
    const std::scoped_lock lock(mutex_);
    block->next = std::exchange(free_[block->size], block);
  }

 private:
  static constexpr std::align_val_t alignment{64};

  /// What stands before the memory of a block.
  struct alignas(64) Block {
    std::size_t size;  ///< binary logarithm of the bytes
    Block* next;       ///< the next free one
  };

  std::mutex mutex_;
  std::array<Block*, 64> free_{};
};

}  // namespace

ImageMemory& kept_memory() {
  static KeptMemory memory;
  return memory;
}

}  // namespace roadstereo
