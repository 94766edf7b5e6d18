#include "damage/view_gaps.hpp"

#include <algorithm>

#include "damage/connected_components.hpp"

namespace roadstereo {
namespace {

// Gaps that belong to a depression: occluded or dark walls. Chosen on synthetic roads and on the labelled pothole maps
// (docs/damage.md, Regions).
constexpr float gap_depth_share = 0.5F;  ///< of the minimum depth of a core, from which a neighbour of the gap is deep
constexpr double min_deep_gap_share = 0.35;  ///< of the neighbours of an enclosed gap that must be deep
constexpr double min_deep_cut_share = 0.6;   ///< of those of a gap that the border of the image, not the view, cuts
constexpr std::size_t max_cut_divisor = 20;  ///< a gap that either cuts is up to 1/20 of the image

/// Mask of the gaps in the view, 0 where there is no measurement.
Image<std::uint8_t> known_cells(const Image<std::uint8_t>& valid, const CommonView& view) {
  Image<std::uint8_t> mask = valid;
  view.fill_outside(mask);
  return mask;
}

/// Whether a gap reaches the border of the view.
bool is_cut(const ConnectedComponent& gap, const CommonView& view) {
  return std::any_of(gap.runs.begin(), gap.runs.end(), [&](const CellRun& run) {
    for (int i = run.first; i <= run.last; ++i) {
      if (view.is_on_border(i, run.row)) return true;
    }
    return false;
  });
}

/// Whether a gap, cut by the border of the view or not, belongs to a depression: most cells around it are deep. One in
/// the intact road belongs to none.
bool is_deep(const ConnectedComponent& gap, bool cut, const DepthCells& cells, const Thresholds& thresholds) {
  if (cut && gap.size > cells.valid.pixels() / max_cut_divisor) return false;
  int neighbours = 0;
  int deep = 0;
  for_each_neighbour(gap, cells.valid.width(), cells.valid.height(), [&](int i, int j) {
    if (cells.valid(i, j) == 0) return;
    ++neighbours;
    deep += cells.depth(i, j) > gap_depth_share * thresholds.min_depth(i, j) ? 1 : 0;
  });
  return deep >= (gap.touches_border ? min_deep_cut_share : min_deep_gap_share) * neighbours;
}

}  // namespace

ViewGaps classify_gaps(const DepthCells& cells, const CommonView& view, const Thresholds& thresholds) {
  const int width = cells.valid.width(), height = cells.valid.height();
  ViewGaps gaps{known_cells(cells.valid, view), {width, height, 0}, {width, height, 0}, {}};
  for (const ConnectedComponent& gap : ConnectedComponents(gaps.known, ConnectedComponents::Foreground::zero)) {
    const bool cut = is_cut(gap, view);
    if (is_deep(gap, cut, cells, thresholds)) {
      fill_component(gap, 255, gaps.deep);
    } else if (cut) {
      fill_component(gap, 255, gaps.unseen);
    }
  }
  gaps.hidden = gaps.unseen;
  view.fill_masked(gaps.hidden);
  return gaps;
}

}  // namespace roadstereo
