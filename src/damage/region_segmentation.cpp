#include "damage/region_segmentation.hpp"

#include <algorithm>
#include <cmath>

#include "damage/candidate_evidence.hpp"
#include "damage/morphology.hpp"

namespace roadstereo {
namespace {

// `_sigmas` are standard deviations of a cell of the intact road. Chosen on synthetic roads and on the labelled pothole
// maps (docs/damage.md, Regions).
constexpr float min_level_sigmas = 2;        ///< minimum depth at the outline
constexpr float foot_sigmas = 0.5F;          ///< minimum depth at the foot of the wall
constexpr int max_level_attempts = 8;        ///< maximum number of levels to separate touching damages
constexpr float max_level_share = 0.9F;      ///< of the floor's depth, the highest of these levels
constexpr std::size_t max_hole_divisor = 4;  ///< holes up to 1/4 of the image are filled

/// Whether a region has cells of an obstacle or of another damage of the same kind.
bool overlaps_other(const Candidate& candidate, SearchImages& images) {
  const CellBox& box = candidate.box();
  const Image<std::uint8_t>& assigned = images.labels(box);
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

/// Cells within a support window of a region that are deeper than its outline, yet not connected with it at that depth:
/// other hollows, beyond a saddle.
BoxMask hollows_beside(const Candidate& candidate, int window_radius, const SearchImages& images) {
  const CellBox around = candidate.box().grown(window_radius, images.depth.width(), images.depth.height());
  BoxMask hollows = candidate.cells.cropped(around);
  const float level = candidate.level;
  for (int j = 0; j < around.rows(); ++j) {
    const float* const depth = images.depth.row(around.first_row + j) + around.first_column;
    const std::uint8_t* const allowed = images.allowed.row(around.first_row + j) + around.first_column;
    std::uint8_t* const cells = hollows.cells().row(j);
    for (int i = 0; i < around.columns(); ++i) {
      const std::uint8_t is_deep = depth[i] > level ? 255 : 0;
      cells[i] = is_deep & allowed[i] & ~cells[i];
    }
  }
  return hollows;
}

/// Extend the region from the flood fill at its level to its outline: to the foot of the wall, and for depressions to
/// the edge in the image, up to the cells of other damages.
void extend_region(const SearchInput& input, SearchImages& images, Candidate& candidate) {
  const std::size_t max_hole = images.depth.pixels() / max_hole_divisor;
  if (input.thresholds.metric()) {
    const float min_depth = foot_sigmas * static_cast<float>(input.depth_cells.noise);
    grow_to_wall_foot(images.field(), candidate.level, min_depth, candidate.cells);
  } else if (candidate.kind == DamageKind::depression) {
    const float min_depth = min_level_sigmas * static_cast<float>(input.depth_cells.noise);
    grow_over_gaps(images.field(), input.gaps.known, min_depth, input.image_edges.window_radius, candidate.cells);
  }
  fill_holes(candidate.cells.cells(), max_hole);
  update_extent(input, images.labels(candidate.box()), candidate);
  if (candidate.size == 0 || candidate.kind == DamageKind::protrusion || input.image_edges.grey.empty()) return;
  const BoxMask other_hollows = hollows_beside(candidate, input.image_edges.window_radius, images);
  refine_outline_by_image(input.image_edges, input.gaps.hidden, other_hollows, window_rows(input, candidate.box()),
                          candidate.cells);
  fill_holes(candidate.cells.cells(), max_hole);
  update_extent(input, images.labels(candidate.box()), candidate);
}

}  // namespace

int window_rows(const SearchInput& input, const CellBox& box) {
  const double aspect =
      input.coordinates.aspect((box.first_column + box.last_column) / 2, (box.first_row + box.last_row) / 2);
  return std::max(1, static_cast<int>(std::lround(aspect * input.image_edges.window_radius)));
}

Candidate segment(const SearchInput& input, const Core& start, DamageKind kind, SearchImages& images) {
  const ConnectedComponent& core = start.cells;
  const DepthField field = images.field();
  const bool metric = input.thresholds.metric();
  Candidate candidate;
  candidate.kind = kind;
  const float floor = floor_depth(images.depth, core);
  const float min_level = std::max(start.saddle, min_level_sigmas * static_cast<float>(input.depth_cells.noise));
  const Outline outline = find_outline(field, core, floor, min_level, metric);
  candidate.level = outline.level;
  candidate.evidence.steepness = outline.steepness;
  const float max_level = std::max(candidate.level, max_level_share * floor);
  const int raises = max_level_attempts - 1;
  const float factor = std::pow(max_level / candidate.level, 1.0F / static_cast<float>(raises));
  candidate.cells = flood_fill(field, core, candidate.level);
  for (int i = 0; i < raises && overlaps_other(candidate, images); ++i) {
    candidate.level *= factor;
    candidate.cells = flood_fill(field, core, candidate.level);
  }
  const bool is_basin = !candidate.box().empty() && !overlaps_other(candidate, images);
  if (is_basin) extend_region(input, images, candidate);
  return candidate;
}

Candidate region_at(const SearchInput& input, const ConnectedComponent& core, float level, float min_cells,
                    const Candidate& lower, SearchImages& images) {
  Candidate raised;
  raised.kind = lower.kind;
  raised.evidence.steepness = lower.evidence.steepness;
  raised.level = level;
  raised.cells = flood_fill(images.field(), core, level);
  if (raised.box().empty() || overlaps_other(raised, images)) return {};
  extend_region(input, images, raised);
  if (static_cast<float>(raised.size) < min_cells || !is_measured(raised, input.depth_cells.valid)) return {};
  add_evidence(input, images, raised);
  return raised;
}

void update_extent(const SearchInput& input, const Image<std::uint8_t>& assigned, Candidate& candidate) {
  const CellBox around = candidate.box();
  CellBox box;
  candidate.size = 0;
  for (int j = around.first_row; j <= around.last_row; ++j) {
    std::uint8_t* const cells = candidate.cells.cells().row(j - around.first_row);
    const std::uint8_t* const labels = assigned.row(j) + around.first_column;
    const std::uint8_t* const unseen = input.gaps.unseen.row(j) + around.first_column;
    for (int i = 0; i < around.columns(); ++i) {
      if (labels[i] != 0 || unseen[i] != 0 || !input.view.contains(around.first_column + i, j)) cells[i] = 0;
      if (cells[i] == 0) continue;
      box.add(around.first_column + i, j);
      ++candidate.size;
    }
  }
  candidate.cells = candidate.cells.cropped(box);
}

bool is_measured(const Candidate& candidate, const Image<std::uint8_t>& valid) {
  const CellBox& box = candidate.box();
  for (int j = box.first_row; j <= box.last_row; ++j) {
    for (int i = box.first_column; i <= box.last_column; ++i) {
      if (candidate.cells(i, j) && valid(i, j) != 0) return true;
    }
  }
  return false;
}

}  // namespace roadstereo
