#pragma once

#include <cstdint>
#include <cstring>

#include "types.h"

/// What a thread of an emulated kernel asks of the others (run_kernel.cpp).
namespace roadstereo::cuda::emulated {

/// Who runs at the moment.
struct Here {
  uint3 thread, block;
  dim3 block_size, grid_size;
};
const Here& here();
void wait_for_block();
void wait_for_warp();
/// Leaves `bits` for the other lanes of the warp, waits for all of them, and returns what `lane` left.
std::uint64_t exchange(std::uint64_t bits, int lane);
/// Lanes of the warp that have not ended, whose `vote` is true.
unsigned ballot(bool vote);
/// The smallest value of the lanes of the warp that have not ended.
int smallest(int value);
int lane();

template <class T>
T exchange_value(T value, int from) {
  static_assert(sizeof(T) <= sizeof(std::uint64_t));
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof(T));
  bits = exchange(bits, from);
  std::memcpy(&value, &bits, sizeof(T));
  return value;
}

}  // namespace roadstereo::cuda::emulated
