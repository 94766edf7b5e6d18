#include "damage/region_levels.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/binned_selection.hpp"
#include "damage/candidate_evidence.hpp"
#include "damage/region_segmentation.hpp"

namespace roadstereo {
namespace {

constexpr float likelier_level_share = 0.7F;  ///< of the floor's depth, the highest level that is tried

/// Depth that a support window of the cells exceeds: the floor of the deepest hole in a region.
float deepest_floor(std::vector<float> depths, int window_radius) {
  const auto window = static_cast<std::size_t>(std::numbers::pi * window_radius * window_radius);
  const auto rank = depths.begin() + static_cast<std::ptrdiff_t>(std::min(window, depths.size() - 1));
  std::nth_element(depths.begin(), rank, depths.end(), std::greater<>());
  return *rank;
}

/// Whether most of a region is shallow beside a floor in it. Half of a cone is deeper than 0.29 of its depth.
bool is_mostly_terrace(std::span<const float> depths, float floor) {
  constexpr float min_median = 0.25F;  // of the floor's depth
  return binned_median(depths) < min_median * floor;
}

/// Runs of the connected part of a candidate deeper than a level that has the most cells deeper than another.
std::vector<CellRun> part_of_hole(const SearchImages& images, const Candidate& candidate, float level, float floor) {
  const CellBox& box = candidate.box();
  Image<std::uint8_t> deep(box.columns(), box.rows());
  for (int j = 0; j < box.rows(); ++j) {
    const float* const depth = images.depth.row(box.first_row + j) + box.first_column;
    const std::uint8_t* const inside = candidate.cells.cells().row(j);
    for (int i = 0; i < box.columns(); ++i) deep(i, j) = depth[i] > level ? inside[i] : std::uint8_t{0};
  }
  std::vector<CellRun> hole;
  std::ptrdiff_t most = 0;
  for (const ConnectedComponent& part : ConnectedComponents(deep)) {
    std::vector<CellRun> runs;
    std::ptrdiff_t cells = 0;
    for (const CellRun& run : part.runs) {
      runs.push_back({box.first_row + run.row, box.first_column + run.first, box.first_column + run.last});
      const float* const depth = images.depth.row(runs.back().row);
      cells += std::count_if(depth + runs.back().first, depth + runs.back().last + 1,
                             [floor](float value) { return value > floor; });
    }
    if (cells <= most) continue;
    most = cells;
    hole = std::move(runs);
  }
  return hole;
}

}  // namespace

void leave_terrace(const SearchInput& input, float min_cells, SearchImages& images, Candidate& candidate) {
  constexpr int levels = 6;
  const std::vector<float> depths = depths_inside(images, candidate);
  const float floor = deepest_floor(depths, input.image_edges.window_radius), first = candidate.level;
  const float last = likelier_level_share * floor;
  if (candidate.lies_in_rut() || last <= first || !is_mostly_terrace(depths, floor)) return;
  std::optional<Candidate> best;
  double confidence = 0;
  for (int k = 1; k <= levels; ++k) {
    const float level = first * std::pow(last / first, static_cast<float>(k) / static_cast<float>(levels));
    const std::vector<CellRun> hole = part_of_hole(images, candidate, level, last);
    ConnectedComponent seeds;
    seeds.runs = hole;
    Candidate raised = region_at(input, seeds, level, min_cells, candidate, images);
    if (raised.size == 0 || is_mostly_terrace(depths_inside(images, raised), floor)) continue;
    const double likelier = confidence_at_best(raised, input.thresholds);
    if (likelier <= confidence) continue;
    confidence = likelier;
    best = std::move(raised);
    if (confidence >= even_confidence) break;
  }
  const bool stands_alone = confidence >= even_confidence || candidate.kind == DamageKind::protrusion;
  if (best && stands_alone) candidate = std::move(*best);
}

void raise_level(const SearchInput& input, const ConnectedComponent& core, float min_cells, SearchImages& images,
                 Candidate& candidate) {
  constexpr int likelier_levels = 3;
  const float first = candidate.level;
  const float last = likelier_level_share * floor_depth(images.depth, core);
  double confidence = confidence_at_best(candidate, input.thresholds);
  for (int k = 1; k <= likelier_levels && last > first; ++k) {
    const float level = first + (last - first) * static_cast<float>(k) / static_cast<float>(likelier_levels);
    Candidate raised = region_at(input, core, level, min_cells, candidate, images);
    if (raised.size == 0) continue;
    const double likelier = confidence_at_best(raised, input.thresholds);
    if (likelier <= confidence) continue;
    confidence = likelier;
    candidate = std::move(raised);
  }
}

}  // namespace roadstereo
