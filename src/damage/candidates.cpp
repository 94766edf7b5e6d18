#include "damage/candidates.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <span>
#include <utility>

#include "core/binned_selection.hpp"
#include "damage/connected_components.hpp"
#include "damage/contours.hpp"
#include "damage/morphology.hpp"
#include "damage/neighbours.hpp"
#include "damage/outline.hpp"

namespace roadstereo {
namespace {

/// Constants of the candidate search. `_sigmas` are standard deviations of a cell of the intact road, `_radii` are
/// multiples of the radius √(area / π) of a region, `_share` are shares of 1. Unless stated otherwise they were chosen
/// on synthetic roads and on the labelled pothole maps (docs/method.md, Damage; `evaluate damage`).
struct SegmentationConstants {
  // Gaps without a measurement that belong to a depression: occluded or dark walls.
  float gap_depth_share = 0.5F;      ///< of the minimum depth of a core, from which a neighbour of the gap is deep
  double min_deep_gap_share = 0.35;  ///< of the neighbours of an enclosed gap that must be deep
  double min_deep_cut_share = 0.6;   ///< of those of a gap that the border of the image cuts, not only that of the view
  std::size_t max_cut_divisor = 20;  ///< a gap that either cuts is up to 1/20 of the image

  // Extent of a region.
  float min_core_area_share = 0.1F;   ///< of the minimum area of a damage, for its core
  float min_level_sigmas = 2;         ///< minimum depth at the outline
  float foot_sigmas = 0.5F;           ///< minimum depth at the foot of the wall
  int max_level_attempts = 8;         ///< maximum number of levels to separate touching damages
  float max_level_share = 0.9F;       ///< of the floor's depth, the highest of these levels
  int likelier_levels = 3;            ///< levels at which a region that is unlikely a damage is tried again
  float likelier_level_share = 0.7F;  ///< of the floor's depth, the highest of these
  std::size_t max_hole_divisor = 4;   ///< holes up to 1/4 of the image are filled
  float rut_floors = 1.3F;            ///< depth in depths of a rut's floor, beyond which it has a pothole: ruts vary
  float outlier_floors = 1.25F;       ///< minimum depth, in depths of the floor, of the cells around an impossible one

  // Surroundings.
  double margin_radii = 0.5;     ///< width of the band around the region
  int min_margin_cells = 3;      ///< minimum width of that band
  float max_hollow_sigmas = 10;  ///< maximum depth of a hollow around a pothole, which counts as road
};
constexpr SegmentationConstants constants{};

/// Confidence from which a region is rather a damage than none.
constexpr double even_confidence = 0.5;

/// Label of a cell higher than a damage can be; damage keeps clear of it.
constexpr std::uint8_t obstacle_label = 3;

/// Label of a cell that belongs to a damage; 0: none.
std::uint8_t label_of(DamageKind kind) {
  return kind == DamageKind::depression ? 1 : 2;
}

/// Inputs of the search.
struct SearchInput {
  DepthCells& depth_cells;  ///< `remove_outliers` changes it
  const Image<std::uint8_t>& road;
  const CommonView& view;
  const Ruts& ruts;
  const Image<std::uint8_t>& known;      ///< 0 in gaps of the view
  const Image<std::uint8_t>& deep_gaps;  ///< 255 in gaps that belong to a depression
  const Image<std::uint8_t>& unseen;     ///< 255 in other gaps that touch its border: what is not seen, or off road
  const Thresholds& thresholds;
  const ImageEdges& image_edges;
};

/// Images of the search for one kind of damage, of one size.
struct SearchImages {
  Image<float> depth;             ///< positive inside this kind of damage
  Image<std::uint8_t> allowed;    ///< 255 where a cell may belong to a damage
  Image<std::uint8_t> visited;    ///< scratch of flood fills
  Image<std::uint8_t>& assigned;  ///< `label_of` the damage that the cell belongs to, `obstacle_label`, or 0; shared by
                                  ///< both kinds

  DepthField field() { return {depth, allowed, visited}; }
};

/// Mask of the gaps in the view, 0 where there is no measurement.
Image<std::uint8_t> known_cells(const Image<std::uint8_t>& valid, const CommonView& view) {
  Image<std::uint8_t> mask(valid.width(), valid.height());
  std::copy_n(valid.row(0), valid.pixels(), mask.row(0));
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
  if (cut && gap.size > cells.valid.pixels() / constants.max_cut_divisor) return false;
  int neighbours = 0;
  int deep = 0;
  for_each_neighbour(gap, cells.valid.width(), cells.valid.height(), [&](int i, int j) {
    if (cells.valid(i, j) == 0) return;
    ++neighbours;
    deep += cells.depth(i, j) > constants.gap_depth_share * thresholds.min_depth(i, j) ? 1 : 0;
  });
  return deep >= (gap.touches_border ? constants.min_deep_cut_share : constants.min_deep_gap_share) * neighbours;
}

SearchImages make_search_images(const SearchInput& input, DamageKind kind, Image<std::uint8_t>& assigned) {
  const DepthCells& cells = input.depth_cells;
  const int width = cells.depth.width(), height = cells.depth.height();
  SearchImages images{Image<float>(width, height), Image<std::uint8_t>(width, height),
                      Image<std::uint8_t>(width, height, 0), assigned};
  const float sign = sign_of(kind);
  const float* const depth = cells.depth.row(0);
  float* const signed_depth = images.depth.row(0);
  for (std::size_t k = 0; k < images.depth.pixels(); ++k) signed_depth[k] = sign * depth[k];
  std::copy_n(cells.valid.row(0), cells.valid.pixels(), images.allowed.row(0));
  std::uint8_t* const allowed = images.allowed.row(0);
  if (kind == DamageKind::protrusion) {
    // A depression is no part of a bump beside it, nor of what surrounds that.
    const std::uint8_t depression = label_of(DamageKind::depression);
    const std::uint8_t* const labels = assigned.row(0);
    for (std::size_t k = 0; k < images.allowed.pixels(); ++k) allowed[k] &= labels[k] == depression ? 0 : 255;
    return images;
  }
  const std::uint8_t* const deep_gaps = input.deep_gaps.row(0);
  for (std::size_t k = 0; k < images.allowed.pixels(); ++k) allowed[k] |= deep_gaps[k];
  return images;
}

/// Mask of the allowed cells deeper than the threshold.
Image<std::uint8_t> core_cells(const SearchImages& images, const Thresholds& thresholds) {
  const int width = images.depth.width();
  Image<std::uint8_t> cores(width, images.depth.height());
  std::vector<float> min_depths(static_cast<std::size_t>(width));
  for (int j = 0; j < images.depth.height(); ++j) {
    thresholds.min_depths(j, min_depths.data());
    const float* const depths = images.depth.row(j);
    const float* const limits = min_depths.data();
    const std::uint8_t* const allowed = images.allowed.row(j);
    std::uint8_t* const row = cores.row(j);
    for (int i = 0; i < width; ++i) {
      const std::uint8_t deep = depths[i] > limits[i] ? 255 : 0;
      row[i] = allowed[i] & deep;
    }
  }
  return cores;
}

/// Maximum depth, or height, of a damage at a cell.
float max_depth(int i, int j, DamageKind kind, const Thresholds& thresholds) {
  return kind == DamageKind::depression ? thresholds.max_depth(i, j) : thresholds.max_height(i, j);
}

/// Call `visit` for the cells of a core that are deeper, or higher, than a damage can be.
template <class Visit>
void for_each_impossible(const SearchInput& input, const ConnectedComponent& core, DamageKind kind,
                         const SearchImages& images, Visit&& visit) {
  for (const CellRun& run : core.runs) {
    for (int i = run.first; i <= run.last; ++i) {
      if (images.depth(i, run.row) > max_depth(i, run.row, kind, input.thresholds)) visit(i, run.row);
    }
  }
}

/// Whether a region has cells of an obstacle or of another damage of the same kind.
bool overlaps_other(const Candidate& candidate, const Image<std::uint8_t>& assigned) {
  const CellBox& box = candidate.box();
  for (int j = box.first_row; j <= box.last_row; ++j) {
    const std::uint8_t* const cells = candidate.cells.cells().row(j - box.first_row);
    const std::uint8_t* const labels = assigned.row(j) + box.first_column;
    for (int i = 0; i < box.columns(); ++i) {
      const int label = cells[i] & labels[i];  // cells are 0 or 255
      if (label == label_of(candidate.kind) || label == obstacle_label) return true;
    }
  }
  return false;
}

/// Remove assigned cells, those outside the view and what is not seen, and recompute the bounding box and the size.
void update_extent(const SearchInput& input, const Image<std::uint8_t>& assigned, Candidate& candidate) {
  const CellBox around = candidate.box();
  CellBox box;
  candidate.size = 0;
  for (int j = around.first_row; j <= around.last_row; ++j) {
    std::uint8_t* const cells = candidate.cells.cells().row(j - around.first_row);
    const std::uint8_t* const labels = assigned.row(j) + around.first_column;
    const std::uint8_t* const unseen = input.unseen.row(j) + around.first_column;
    for (int i = 0; i < around.columns(); ++i) {
      if (labels[i] != 0 || unseen[i] != 0 || !input.view.contains(around.first_column + i, j)) cells[i] = 0;
      if (cells[i] == 0) continue;
      box.add(around.first_column + i, j);
      ++candidate.size;
    }
  }
  candidate.cells = candidate.cells.cropped(box);
}

/// Cells within a support window of a region that are deeper than its outline, yet not connected with it at that depth:
/// other hollows, beyond a saddle.
BoxMask hollows_beside(const Candidate& candidate, int window_radius, const SearchImages& images) {
  const CellBox around = candidate.box().grown(window_radius, images.depth.width(), images.depth.height());
  BoxMask hollows(around);
  for (int j = around.first_row; j <= around.last_row; ++j) {
    for (int i = around.first_column; i <= around.last_column; ++i) {
      const bool is_deep = images.allowed(i, j) != 0 && images.depth(i, j) > candidate.level;
      hollows.set(i, j, is_deep && !candidate.cells(i, j));
    }
  }
  return hollows;
}

/// Extend the region from the flood fill at its level to its outline: to the foot of the wall, and for depressions to
/// the edge in the image, up to the cells of other damages.
void extend_region(const SearchInput& input, SearchImages& images, Candidate& candidate) {
  const std::size_t max_hole = images.depth.pixels() / constants.max_hole_divisor;
  if (input.thresholds.metric()) {
    const float min_depth = constants.foot_sigmas * static_cast<float>(input.depth_cells.noise);
    grow_to_wall_foot(images.field(), candidate.level, min_depth, candidate.cells);
  } else if (candidate.kind == DamageKind::depression) {
    const float min_depth = constants.min_level_sigmas * static_cast<float>(input.depth_cells.noise);
    grow_over_gaps(images.field(), input.known, min_depth, input.image_edges.window_radius, candidate.cells);
  }
  fill_holes(candidate.cells.cells(), max_hole);
  update_extent(input, images.assigned, candidate);
  if (candidate.size == 0 || candidate.kind == DamageKind::protrusion || input.image_edges.grey.empty()) return;
  const BoxMask other_hollows = hollows_beside(candidate, input.image_edges.window_radius, images);
  refine_outline_by_image(input.image_edges, input.unseen, other_hollows, candidate.cells);
  fill_holes(candidate.cells.cells(), max_hole);
  update_extent(input, images.assigned, candidate);
}

/// Segment the region around a core. If it runs into another damage or an obstacle, the level is raised above the
/// saddle between them. Size 0 if there is no such region.
Candidate segment(const SearchInput& input, const ConnectedComponent& core, DamageKind kind, SearchImages& images) {
  const DepthField field = images.field();
  const bool metric = input.thresholds.metric();
  Candidate candidate;
  candidate.kind = kind;
  const float floor = floor_depth(field, core);
  const float min_level = constants.min_level_sigmas * static_cast<float>(input.depth_cells.noise);
  const Outline outline = find_outline(field, core, floor, min_level, metric);
  candidate.level = outline.level;
  candidate.evidence.steepness = outline.steepness;
  const float max_level = std::max(candidate.level, constants.max_level_share * floor);
  const int raises = constants.max_level_attempts - 1;
  const float factor = std::pow(max_level / candidate.level, 1.0F / static_cast<float>(raises));
  candidate.cells = flood_fill(field, core, candidate.level);
  for (int i = 0; i < raises && overlaps_other(candidate, images.assigned); ++i) {
    candidate.level *= factor;
    candidate.cells = flood_fill(field, core, candidate.level);
  }
  const bool is_basin = !candidate.box().empty() && !overlaps_other(candidate, images.assigned);
  if (is_basin) extend_region(input, images, candidate);
  return candidate;
}

/// Shares of the contour of a region, with its cells at the border of the view, on that border and on that of what is
/// seen: the rim of a damage is not known there.
void measure_border(const BoxMask& region, const CommonView& view, const Image<std::uint8_t>& unseen,
                    DamageEvidence& evidence) {
  const int columns = unseen.width(), rows = unseen.height();
  const CellBox& box = region.box();
  double contour = 0, on_border = 0, on_gap = 0;
  for (int j = box.first_row; j <= box.last_row; ++j) {
    for (int i = box.first_column; i <= box.last_column; ++i) {
      if (!region(i, j)) continue;
      const bool at_border = view.is_on_border(i, j);
      bool at_gap = false;
      for_each_neighbour(i, j, columns, rows, [&](int x, int y) { at_gap |= unseen(x, y) != 0 && !region(x, y); });
      if (!at_border && !at_gap && !is_on_contour(region, i, j, columns, rows)) continue;
      ++contour;
      on_border += at_border ? 1 : 0;
      on_gap += at_gap && !at_border ? 1 : 0;
    }
  }
  if (contour == 0) return;
  evidence.border_share = on_border / contour;
  evidence.unseen_share = on_gap / contour;
}

/// Share of the band around a candidate that is road, the relief of a rough one included, or a hollow no deeper than
/// the outline. Cells of other damages and outside the view do not count; 1 if no cell is left.
double road_share(const SearchInput& input, const Candidate& candidate, const Image<std::uint8_t>& assigned) {
  const double radius = std::sqrt(static_cast<double>(candidate.size) / std::numbers::pi);
  const int margin = std::max(constants.min_margin_cells, static_cast<int>(constants.margin_radii * radius));
  const CellBox around = candidate.box().grown(margin, input.road.width(), input.road.height());
  const BoxMask dilated = dilate(candidate.cells, margin, around);
  const float sign = sign_of(candidate.kind);
  const float max_hollow =
      candidate.kind == DamageKind::depression
          ? std::min(candidate.level, constants.max_hollow_sigmas * static_cast<float>(input.depth_cells.noise))
          : 0.0F;
  double cells = 0;
  double on_road = 0;
  for (int j = around.first_row; j <= around.last_row; ++j) {
    for (int i = around.first_column; i <= around.last_column; ++i) {
      const bool other_damage = assigned(i, j) != 0 && assigned(i, j) != obstacle_label;
      if (!dilated(i, j) || candidate.cells(i, j) || other_damage || !input.view.contains(i, j)) continue;
      ++cells;
      if (input.depth_cells.valid(i, j) == 0) continue;
      const float depth = sign * input.depth_cells.depth(i, j);
      const bool is_relief = std::abs(depth) < input.thresholds.relief(i, j);
      on_road += input.road(i, j) != 0 || is_relief || (depth > 0 && depth <= max_hollow) ? 1 : 0;
    }
  }
  return cells == 0 ? 1 : on_road / cells;
}

/// Significance of the rut that a region lies in, times the share of its cells that do.
double rut_significance(const BoxMask& region, std::size_t size, const Ruts& ruts) {
  if (ruts.empty()) return 0;
  std::vector<std::size_t> counts(ruts.significances.size() + 1, 0);
  const CellBox& box = region.box();
  for (int j = box.first_row; j <= box.last_row; ++j) {
    for (int i = box.first_column; i <= box.last_column; ++i) {
      if (region(i, j)) ++counts[ruts.labels(i, j)];
    }
  }
  double most = 0;
  for (std::size_t k = 1; k < counts.size(); ++k) {
    most = std::max(most, ruts.significances[k - 1] * static_cast<double>(counts[k]) / static_cast<double>(size));
  }
  return most;
}

/// Depths of the cells of a candidate.
std::vector<float> depths_inside(const SearchImages& images, const Candidate& candidate) {
  std::vector<float> inside;
  inside.reserve(candidate.size);
  const CellBox& box = candidate.box();
  for (int j = box.first_row; j <= box.last_row; ++j) {
    const std::uint8_t* const is_inside = candidate.cells.cells().row(j - box.first_row);
    for (int i = box.first_column; i <= box.last_column; ++i) {
      if (is_inside[i - box.first_column] != 0) inside.push_back(images.depth(i, j));
    }
  }
  return inside;
}

/// Measure what distinguishes a damage from noise and from what is not road.
void add_evidence(const SearchInput& input, SearchImages& images, Candidate& candidate) {
  constexpr int near_cells = 3;  // closer to the rim the depth is smoothed
  constexpr double band_radii = 1;
  std::vector<float> inside = depths_inside(images, candidate);
  const RobustNormal damage = robust_normal(inside);
  const RobustNormal around = depths_around(images.field(), candidate.cells, near_cells, band_radii);
  const double window = input.image_edges.window_radius;
  const double samples = std::max(1.0, static_cast<double>(candidate.size) / (std::numbers::pi * window * window));
  DamageEvidence& evidence = candidate.evidence;
  evidence.contrast_sigmas = (damage.median - around.median) / std::max(around.sigma, input.depth_cells.noise);
  evidence.significance = evidence.contrast_sigmas * std::sqrt(samples);
  evidence.road_share = road_share(input, candidate, images.assigned);
  measure_border(candidate.cells, input.view, input.unseen, evidence);
  if (candidate.kind == DamageKind::depression) {
    evidence.rut_significance = rut_significance(candidate.cells, candidate.size, input.ruts);
  }
}

/// Assign the cells of a candidate to its kind.
void assign(const Candidate& candidate, Image<std::uint8_t>& assigned) {
  const CellBox& box = candidate.box();
  for (int row = box.first_row; row <= box.last_row; ++row) {
    for (int column = box.first_column; column <= box.last_column; ++column) {
      if (candidate.cells(column, row)) assigned(column, row) = label_of(candidate.kind);
    }
  }
}

/// Turn outliers into gaps: the cells around those that are deeper, or higher, than a damage can be, as wrong matches
/// at snow or dirt make them. They take the depth of the floor.
void remove_outliers(const SearchInput& input, const ConnectedComponent& core, DamageKind kind, SearchImages& images) {
  std::vector<CellRun> impossible;
  for_each_impossible(input, core, kind, images, [&](int i, int j) { impossible.push_back({j, i, i}); });
  if (impossible.empty()) return;
  ConnectedComponent seeds;
  seeds.runs = impossible;
  const float floor = floor_depth(images.field(), core);
  constexpr int smoothing_radius = 2;  // of the 5×5 binomial mean, which spreads them
  const BoxMask wrong = flood_fill(images.field(), seeds, constants.outlier_floors * floor);
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

/// Whether the floor of a core is deeper, or higher, than a damage can be.
bool is_obstacle(const SearchInput& input, const ConnectedComponent& core, DamageKind kind,
                 const SearchImages& images) {
  if (!input.thresholds.metric()) return false;
  std::vector<float> shares;  // of the depth that a damage can have at the cell
  shares.reserve(core.size);
  for (const CellRun& run : core.runs) {
    for (int i = run.first; i <= run.last; ++i) {
      shares.push_back(images.depth(i, run.row) / max_depth(i, run.row, kind, input.thresholds));
    }
  }
  const bool is_deep = std::any_of(shares.begin(), shares.end(), [](float share) { return share > 1; });
  return is_deep && floor_of(std::move(shares)) > 1;
}

/// Whether a cell of the candidate is measured, not interpolated.
bool is_measured(const Candidate& candidate, const Image<std::uint8_t>& valid) {
  const CellBox& box = candidate.box();
  for (int j = box.first_row; j <= box.last_row; ++j) {
    for (int i = box.first_column; i <= box.last_column; ++i) {
      if (candidate.cells(i, j) && valid(i, j) != 0) return true;
    }
  }
  return false;
}

/// Confidence of a region before its wall is measured, and the agreement of the pictures, which makes no damage of one
/// that none could be: that of a steep wall.
double confidence_at_best(const Candidate& candidate, const Thresholds& thresholds) {
  DamageEvidence steepest = candidate.evidence;
  if (candidate.kind == DamageKind::depression && thresholds.walls_measured()) steepest.likely_wall_slope = 1;
  return steepest.confidence();
}

/// The region of a hollow at another level, with its evidence; size 0 if it is none.
Candidate region_at(const SearchInput& input, const ConnectedComponent& core, float level, float min_cells,
                    const Candidate& lower, SearchImages& images) {
  Candidate raised;
  raised.kind = lower.kind;
  raised.evidence.steepness = lower.evidence.steepness;
  raised.level = level;
  raised.cells = flood_fill(images.field(), core, level);
  if (raised.box().empty() || overlaps_other(raised, images.assigned)) return {};
  extend_region(input, images, raised);
  if (static_cast<float>(raised.size) < min_cells || !is_measured(raised, input.depth_cells.valid)) return {};
  add_evidence(input, images, raised);
  return raised;
}

/// Depth that a support window of the cells exceeds: the floor of the deepest hole in a region.
float deepest_floor(std::vector<float> depths, int window_radius) {
  const auto window = static_cast<std::size_t>(std::numbers::pi * window_radius * window_radius);
  const auto rank = depths.begin() + static_cast<std::ptrdiff_t>(std::min(window, depths.size() - 1));
  std::nth_element(depths.begin(), rank, depths.end(), std::greater<>());
  return *rank;
}

/// Whether most of a region is shallow beside a floor in it. Half of a cone is deeper than 0.29 of its depth.
bool is_mostly_terrace(std::span<const float> depths, float floor) {
  constexpr float min_median = 0.2F;  // of the floor's depth
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

/// A hole beside a step of the road, as at the edge of an overlay, from the level that leaves out the lower side of the
/// step, where the outline has run out into that.
void leave_terrace(const SearchInput& input, float min_cells, SearchImages& images, Candidate& candidate) {
  constexpr int levels = 6;
  const std::vector<float> depths = depths_inside(images, candidate);
  const float floor = deepest_floor(depths, input.image_edges.window_radius), first = candidate.level;
  const float last = constants.likelier_level_share * floor;
  if (candidate.evidence.rut_significance > 0 || last <= first || !is_mostly_terrace(depths, floor)) return;
  for (int k = 1; k <= levels; ++k) {
    const float level = first * std::pow(last / first, static_cast<float>(k) / static_cast<float>(levels));
    const std::vector<CellRun> hole = part_of_hole(images, candidate, level, last);
    ConnectedComponent seeds;
    seeds.runs = hole;
    Candidate raised = region_at(input, seeds, level, min_cells, candidate, images);
    if (raised.size == 0 || is_mostly_terrace(depths_inside(images, raised), floor)) continue;
    if (confidence_at_best(raised, input.thresholds) >= even_confidence) candidate = std::move(raised);
    return;
  }
}

/// The hollow around a core at a higher level, if it is likelier a damage there. Where the relief of the road is as
/// steep as the wall, the outline runs out of the hole into a shallow one, and the contrast is lost.
void raise_level(const SearchInput& input, const ConnectedComponent& core, float min_cells, SearchImages& images,
                 Candidate& candidate) {
  const float first = candidate.level;
  const float last = constants.likelier_level_share * floor_depth(images.field(), core);
  double confidence = confidence_at_best(candidate, input.thresholds);
  for (int k = 1; k <= constants.likelier_levels && last > first; ++k) {
    const float level = first + (last - first) * static_cast<float>(k) / static_cast<float>(constants.likelier_levels);
    Candidate raised = region_at(input, core, level, min_cells, candidate, images);
    if (raised.size == 0) continue;
    const double likelier = confidence_at_best(raised, input.thresholds);
    if (likelier <= confidence) continue;
    confidence = likelier;
    candidate = std::move(raised);
  }
}

/// Add the potholes in a rut, clearly deeper than its floor, and take them out of it. They are measured below the mean
/// section of the rut, which counts as road.
void add_potholes_of_rut(const SearchInput& input, float min_cells, SearchImages& images, Candidate& rut,
                         std::vector<Candidate>& found) {
  constexpr double even_if_confirmed = 0.12;  // the agreement of the pictures adds up to 2 to the log-odds
  const std::size_t before = found.size();
  const Image<float> depth = images.depth;
  Image<std::uint8_t> cores(depth.width(), depth.height(), 0), road = input.road;
  input.ruts.fill(255, road);
  for (int j = 0; j < depth.height(); ++j) {
    for (int i = 0; i < depth.width(); ++i) {
      const std::size_t label = input.ruts.labels(i, j);
      if (label == 0) continue;
      const float floor_m = constants.rut_floors * input.ruts.floors_m[label - 1];
      const float floor = input.thresholds.pixels_below(double{floor_m}, i, j);
      if (rut.cells(i, j) && depth(i, j) > floor + input.thresholds.min_depth(i, j)) cores(i, j) = 255;
      images.depth(i, j) -= input.thresholds.pixels_below(double{input.ruts.depth_m(i, j)}, i, j);
    }
  }
  const SearchInput in_rut{input.depth_cells, road,         input.view,       input.ruts,       input.known,
                           input.deep_gaps,   input.unseen, input.thresholds, input.image_edges};
  for (const ConnectedComponent& core : ConnectedComponents(cores)) {
    if (static_cast<float>(core.size) < constants.min_core_area_share * min_cells) continue;
    Candidate pothole = segment(in_rut, core, rut.kind, images);
    if (static_cast<float>(pothole.size) < min_cells || !is_measured(pothole, input.depth_cells.valid)) continue;
    add_evidence(in_rut, images, pothole);
    pothole.evidence.rut_significance = 0;
    if (confidence_at_best(pothole, input.thresholds) < even_if_confirmed) continue;
    assign(pothole, images.assigned);
    found.push_back(std::move(pothole));
  }
  images.depth = depth;
  if (found.size() > before) update_extent(input, images.assigned, rut);
}

/// Segment the region around a core and add it to `found` if it is large enough and surrounded by road.
void add_candidate(const SearchInput& input, const ConnectedComponent& core, DamageKind kind, SearchImages& images,
                   std::vector<Candidate>& found) {
  const float min_cells = input.thresholds.min_cells(core.runs.front().first, core.runs.front().row);
  if (static_cast<float>(core.size) < constants.min_core_area_share * min_cells) return;
  Candidate candidate = segment(input, core, kind, images);
  if (candidate.size == 0 || static_cast<float>(candidate.size) < min_cells) return;
  if (!is_measured(candidate, input.depth_cells.valid)) return;
  add_evidence(input, images, candidate);
  const bool is_hollow = kind == DamageKind::depression && input.thresholds.metric();
  if (is_hollow && confidence_at_best(candidate, input.thresholds) < even_confidence) {
    raise_level(input, core, min_cells, images, candidate);
  }
  if (is_hollow) leave_terrace(input, min_cells, images, candidate);
  if (confidence_at_best(candidate, input.thresholds) < min_candidate_confidence) return;
  if (candidate.evidence.rut_significance > 0) add_potholes_of_rut(input, min_cells, images, candidate, found);
  assign(candidate, images.assigned);
  found.push_back(std::move(candidate));
}

/// Add the candidates of one kind, from the largest core to the smallest.
void find_kind(const SearchInput& input, DamageKind kind, Image<std::uint8_t>& assigned,
               std::vector<Candidate>& found) {
  SearchImages images = make_search_images(input, kind, assigned);
  const ConnectedComponents components(core_cells(images, input.thresholds));
  std::vector<ConnectedComponent> cores(components.begin(), components.end());
  std::stable_sort(cores.begin(), cores.end(),
                   [](const auto& one, const auto& other) { return one.size > other.size; });
  std::erase_if(cores, [&](const ConnectedComponent& core) {
    if (!is_obstacle(input, core, kind, images)) return false;
    for_each_impossible(input, core, kind, images, [&](int i, int j) { assigned(i, j) = obstacle_label; });
    return true;
  });
  for (const ConnectedComponent& core : cores) {
    const CellRun& first = core.runs.front();
    if (assigned(first.first, first.row) != 0) continue;
    remove_outliers(input, core, kind, images);
    add_candidate(input, core, kind, images, found);
  }
}

}  // namespace

std::vector<Candidate> find_candidates(DepthCells& depth_cells, const Image<std::uint8_t>& road, const CommonView& view,
                                       const Ruts& ruts, const Thresholds& thresholds, const ImageEdges& image_edges,
                                       bool protrusions) {
  const Image<std::uint8_t> known = known_cells(depth_cells.valid, view);
  const ConnectedComponents gaps(known, ConnectedComponents::Foreground::zero);
  Image<std::uint8_t> deep_gaps(road.width(), road.height(), 0), unseen = deep_gaps;
  for (const ConnectedComponent& gap : gaps) {
    const bool cut = is_cut(gap, view);
    if (is_deep(gap, cut, depth_cells, thresholds)) {
      fill_component(gap, 255, deep_gaps);
    } else if (cut) {
      fill_component(gap, 255, unseen);
    }
  }
  const SearchInput input{depth_cells, road, view, ruts, known, deep_gaps, unseen, thresholds, image_edges};
  std::vector<Candidate> found;
  Image<std::uint8_t> assigned(road.width(), road.height(), 0);
  find_kind(input, DamageKind::depression, assigned, found);
  if (protrusions) find_kind(input, DamageKind::protrusion, assigned, found);
  return found;
}

}  // namespace roadstereo
