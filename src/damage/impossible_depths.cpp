#include "damage/impossible_depths.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "damage/morphology.hpp"

namespace roadstereo {
namespace {

/// Maximum depth, or height, of a damage at a cell.
float max_depth(int i, int j, DamageKind kind, const Thresholds& thresholds) {
  return kind == DamageKind::depression ? thresholds.max_depth(i, j) : thresholds.max_height(i, j);
}

/// Call `visit` for the cells of a core that are deeper, or higher, than a damage can be.
template <class Visit>
void for_each_impossible(const SearchInput& input, const ConnectedComponent& core, DamageKind kind,
                         const Image<float>& depth, Visit&& visit) {
  for (const CellRun& run : core.runs) {
    for (int i = run.first; i <= run.last; ++i) {
      if (depth(i, run.row) > max_depth(i, run.row, kind, input.thresholds)) visit(i, run.row);
    }
  }
}

}  // namespace

bool is_obstacle(const SearchInput& input, const ConnectedComponent& core, DamageKind kind, const Image<float>& depth,
                 Image<std::uint8_t>& assigned) {
  if (!input.thresholds.metric()) return false;
  std::vector<float> shares;  // of the depth that a damage can have at the cell
  shares.reserve(core.size);
  for (const CellRun& run : core.runs) {
    for (int i = run.first; i <= run.last; ++i) {
      shares.push_back(depth(i, run.row) / max_depth(i, run.row, kind, input.thresholds));
    }
  }
  const bool is_deep = std::any_of(shares.begin(), shares.end(), [](float share) { return share > 1; });
  if (!is_deep || floor_of(std::move(shares)) <= 1) return false;
  for_each_impossible(input, core, kind, depth, [&](int i, int j) { assigned(i, j) = obstacle_label; });
  return true;
}

bool has_outliers(const SearchInput& input, const ConnectedComponent& core, DamageKind kind,
                  const Image<float>& depth) {
  bool any = false;
  for_each_impossible(input, core, kind, depth, [&](int, int) { any = true; });
  return any;
}

void remove_outliers(const SearchInput& input, const ConnectedComponent& core, DamageKind kind, SearchImages& images) {
  std::vector<CellRun> impossible;
  for_each_impossible(input, core, kind, images.depth, [&](int i, int j) { impossible.push_back({j, i, i}); });
  if (impossible.empty()) return;
  ConnectedComponent seeds;
  seeds.runs = impossible;
  constexpr float outlier_floors = 1.25F;  // minimum depth, in depths of the floor, around an impossible cell
  const float floor = floor_depth(images.depth, core);
  constexpr int smoothing_radius = 2;  // of the 5×5 binomial mean, which spreads them
  const BoxMask wrong = flood_fill(images.field(), seeds, outlier_floors * floor);
  const CellBox box = wrong.box().grown(smoothing_radius, images.depth.width(), images.depth.height());
  const BoxMask outliers = dilate(wrong, smoothing_radius, box);
  for (int j = box.first_row; j <= box.last_row; ++j) {
    for (int i = box.first_column; i <= box.last_column; ++i) {
      if (!outliers(i, j)) continue;
      images.depth(i, j) = floor;
      input.depth_cells.depth(i, j) = sign_of(kind) * floor;
      input.depth_cells.valid(i, j) = 0;
    }
  }
}

}  // namespace roadstereo
