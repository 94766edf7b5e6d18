#include "damage/inside_rim.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "damage/candidate_evidence.hpp"
#include "damage/connected_components.hpp"
#include "damage/contours.hpp"
#include "damage/image_outline.hpp"
#include "damage/neighbours.hpp"
#include "damage/region_segmentation.hpp"

namespace roadstereo {
namespace {

/// Depth of the rim where an average over a Gaussian of that standard deviation (cells) has left a wall of height
/// `floor` this steep. Both walls, the measured and the true one, are taken for straight slopes around the same middle.
float rim_depth(float floor, float slope, double smoothing) {
  const double half_run_of_step = std::sqrt(std::numbers::pi / 2);  // standard deviations: of a vertical wall
  const double half_run = 0.5 * double{floor} / double{slope}, spread = half_run_of_step * smoothing;
  const double true_half_run = std::sqrt(std::max(0.0, half_run * half_run - spread * spread));
  return static_cast<float>(0.5 * (1 - true_half_run / half_run)) * floor;
}

/// Steepest slope near a cell.
float slope_near(const Image<float>& depth, const CellIndex& cell) {
  constexpr int radius = 2;  // from the foot of a wall to its middle
  float steepest = 0;
  for (int j = std::max(0, cell.row - radius); j <= std::min(depth.height() - 1, cell.row + radius); ++j) {
    for (int i = std::max(0, cell.column - radius); i <= std::min(depth.width() - 1, cell.column + radius); ++i) {
      steepest = std::max(steepest, slope_at(depth, i, j));
    }
  }
  return steepest;
}

/// Remove cells shallower than the rim from the border of a region inwards. Returns whether there were any.
bool peel_to_rim(const Image<float>& depth, float floor, double smoothing, BoxMask& region) {
  constexpr double max_sigmas = 2.5;  // so far beyond the rim nothing of a wall is left
  const int steps = static_cast<int>(std::ceil(max_sigmas * smoothing));
  bool any = false;
  std::vector<CellIndex> front = contour_cells(region, depth.width(), depth.height()), removed;
  for (int k = 0; k < steps && !front.empty(); ++k) {
    removed.clear();
    for (const CellIndex cell : front) {
      if (!region(cell.column, cell.row)) continue;
      if (!(depth(cell.column, cell.row) < rim_depth(floor, slope_near(depth, cell), smoothing))) continue;
      region.set(cell.column, cell.row, false);
      removed.push_back(cell);
    }
    any |= !removed.empty();
    front.clear();
    for (const CellIndex cell : removed) {
      for_each_neighbour(cell.column, cell.row, depth.width(), depth.height(), [&](int i, int j) {
        if (region(i, j)) front.push_back({i, j});
      });
    }
  }
  return any;
}

/// Reduce a region to the largest connected part of it that is in `within`. Returns whether there is one.
bool keep_largest_part(const BoxMask& within, BoxMask& region) {
  region = region.cropped(within.box());
  std::uint8_t* const cells = region.cells().row(0);
  const std::uint8_t* const other = within.cells().row(0);
  for (std::size_t k = 0; k < region.cells().pixels(); ++k) cells[k] &= other[k];
  const ConnectedComponents parts(region.cells());
  const auto largest = std::max_element(parts.begin(), parts.end(),
                                        [](const auto& one, const auto& two) { return one.size < two.size; });
  for (auto part = parts.begin(); part != parts.end(); ++part) {
    if (part != largest) fill_component(*part, 0, region.cells());
  }
  return parts.size() > 0;
}

}  // namespace

BoxMask inside_rim(const SearchInput& input, const SearchImages& images, const Candidate& candidate) {
  if (!input.thresholds.metric() || candidate.lies_in_rut()) return {};
  BoxMask inside = candidate.cells;
  const float floor = floor_of(depths_inside(images, candidate));
  if (!peel_to_rim(images.depth, floor, input.depth_cells.smoothing, inside)) return {};
  if (candidate.kind == DamageKind::depression && !input.image_edges.grey.empty()) {
    refine_outline_by_image(input.image_edges, input.gaps.hidden, BoxMask(candidate.box()),
                            window_rows(input, candidate.box()), inside);
  }
  fill_holes(inside.cells(), inside.cells().pixels());
  return keep_largest_part(candidate.cells, inside) ? inside : BoxMask();
}

}  // namespace roadstereo
