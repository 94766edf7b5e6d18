#include "core/scratch.hpp"

#include <algorithm>
#include <bit>

namespace roadstereo {
namespace {

std::pmr::memory_resource*& in_force() {
  thread_local std::pmr::memory_resource* memory = nullptr;
  return memory;
}

}  // namespace

ReusedBlocks::~ReusedBlocks() {
  for (const Block& block : free_)
    std::pmr::new_delete_resource()->deallocate(block.memory, block.size, block.alignment);
}

void* ReusedBlocks::do_allocate(std::size_t bytes, std::size_t alignment) {
  const std::size_t size = std::bit_ceil(bytes);
  const auto kept = std::find_if(free_.begin(), free_.end(), [&](const Block& block) {
    return block.size == size && block.alignment == alignment;
  });
  if (kept == free_.end()) return std::pmr::new_delete_resource()->allocate(size, alignment);
  void* const memory = kept->memory;
  *kept = free_.back();
  free_.pop_back();
  return memory;
}

void ReusedBlocks::do_deallocate(void* memory, std::size_t bytes, std::size_t alignment) {
  free_.push_back({memory, std::bit_ceil(bytes), alignment});
}

ScratchScope::ScratchScope(ScratchMemory& memory) : previous_(in_force()) {
  in_force() = &memory.resource();
}

ScratchScope::~ScratchScope() {
  in_force() = previous_;
}

std::pmr::memory_resource* ScratchScope::memory() {
  return in_force() != nullptr ? in_force() : std::pmr::new_delete_resource();
}

}  // namespace roadstereo
