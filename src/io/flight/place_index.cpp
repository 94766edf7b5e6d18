#include "io/flight/place_index.hpp"

#include <algorithm>
#include <cmath>

namespace roadstereo::io {
namespace {

/// Calls `visit` for each cell that the box around a ball touches. Returns false, without a call, if there are too many
/// or the ball is not finite.
template <class Visit>
bool for_each_cell(int piece, const std::array<double, 3>& centre_m, double radius_m, const Visit& visit) {
  constexpr double cell_m = 4, most = 1000, farthest = 1e9;
  std::array<int, 3> first{}, last{};
  double count = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double low = std::floor((centre_m[axis] - radius_m) / cell_m);
    const double high = std::floor((centre_m[axis] + radius_m) / cell_m);
    count *= high - low + 1;
    if (!(low > -farthest && high < farthest && count <= most)) return false;
    first[axis] = static_cast<int>(low);
    last[axis] = static_cast<int>(high);
  }
  for (int i = first[0]; i <= last[0]; ++i) {
    for (int j = first[1]; j <= last[1]; ++j) {
      for (int k = first[2]; k <= last[2]; ++k) visit({piece, i, j, k});
    }
  }
  return true;
}

void add_once(std::int64_t id, std::vector<std::int64_t>& ids) {
  if (std::find(ids.begin(), ids.end(), id) == ids.end()) ids.push_back(id);
}

}  // namespace

void PlaceIndex::add(std::int64_t id, int piece, const std::array<double, 3>& centre_m, double radius_m) {
  const auto enter = [&](const Cell& cell) { add_once(id, cells_[cell]); };
  if (!for_each_cell(piece, centre_m, radius_m, enter)) add_once(id, large_);
}

std::vector<std::int64_t> PlaceIndex::near(int piece, const std::array<double, 3>& centre_m, double radius_m) const {
  std::vector<std::int64_t> ids = large_;
  const auto collect = [&](const std::vector<std::int64_t>& more) { ids.insert(ids.end(), more.begin(), more.end()); };
  const auto look_up = [&](const Cell& cell) {
    if (const auto found = cells_.find(cell); found != cells_.end()) collect(found->second);
  };
  if (!for_each_cell(piece, centre_m, radius_m, look_up)) {
    for (const auto& [cell, entered] : cells_) collect(entered);
  }
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  return ids;
}

}  // namespace roadstereo::io
