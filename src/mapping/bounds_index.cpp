#include "mapping/bounds_index.hpp"

#include <algorithm>

namespace roadstereo {
namespace {

/// Calls `visit` for each block that a box touches. Returns false, without a call, if there are too many.
template <class Visit>
bool for_each_block(const CellBounds& bounds, const Visit& visit) {
  constexpr int block_bits = 6;  // 64 × 64 cells
  constexpr std::int64_t most = 1000;
  const std::int32_t i0 = bounds.first[0] >> block_bits, i1 = bounds.last[0] >> block_bits;
  const std::int32_t j0 = bounds.first[1] >> block_bits, j1 = bounds.last[1] >> block_bits;
  if ((std::int64_t{i1} - i0 + 1) * (std::int64_t{j1} - j0 + 1) > most) return false;
  for (std::int32_t j = j0; j <= j1; ++j) {
    for (std::int32_t i = i0; i <= i1; ++i) visit(std::array{i, j});
  }
  return true;
}

void enter(std::size_t number, std::vector<std::size_t>& numbers) {
  if (std::find(numbers.begin(), numbers.end(), number) == numbers.end()) numbers.push_back(number);
}

}  // namespace

void BoundsIndex::add(std::size_t number, const CellBounds& bounds) {
  if (!bounds.overlaps(bounds)) return;
  if (!for_each_block(bounds, [&](const auto& block) { enter(number, blocks_[block]); })) enter(number, large_);
}

std::vector<std::size_t> BoundsIndex::near(const CellBounds& bounds) const {
  if (!bounds.overlaps(bounds)) return {};
  std::vector<std::size_t> numbers = large_;
  const auto collect = [&](const std::vector<std::size_t>& more) {
    numbers.insert(numbers.end(), more.begin(), more.end());
  };
  const auto look_up = [&](const auto& block) {
    if (const auto found = blocks_.find(block); found != blocks_.end()) collect(found->second);
  };
  if (!for_each_block(bounds, look_up)) {
    for (const auto& [block, entered] : blocks_) collect(entered);
  }
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  return numbers;
}

}  // namespace roadstereo
