#include "core/scratch.hpp"

namespace roadstereo {
namespace {

std::pmr::memory_resource*& in_force() {
  thread_local std::pmr::memory_resource* memory = nullptr;
  return memory;
}

}  // namespace

ScratchScope::ScratchScope(std::pmr::memory_resource& memory) : previous_(in_force()) {
  in_force() = &memory;
}

ScratchScope::~ScratchScope() {
  in_force() = previous_;
}

std::pmr::memory_resource* ScratchScope::memory() {
  return in_force() != nullptr ? in_force() : std::pmr::new_delete_resource();
}

}  // namespace roadstereo
