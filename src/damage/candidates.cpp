#include "damage/candidates.hpp"

#include <algorithm>
#include <utility>

#include "damage/candidate_evidence.hpp"
#include "damage/candidate_search.hpp"
#include "damage/connected_components.hpp"
#include "damage/impossible_depths.hpp"
#include "damage/inside_rim.hpp"
#include "damage/region_levels.hpp"
#include "damage/region_segmentation.hpp"

namespace roadstereo {
namespace {

constexpr float min_core_area_share = 0.1F;  ///< of the minimum area of a damage, for its core

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
  const std::uint8_t* const deep_gaps = input.gaps.deep.row(0);
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

/// Assign the cells of a candidate to its kind.
void assign(const Candidate& candidate, Image<std::uint8_t>& assigned) {
  const CellBox& box = candidate.box();
  for (int row = box.first_row; row <= box.last_row; ++row) {
    for (int column = box.first_column; column <= box.last_column; ++column) {
      if (candidate.cells(column, row)) assigned(column, row) = label_of(candidate.kind);
    }
  }
}

/// Add the potholes in a rut, clearly deeper than its floor, and take them out of it. They are measured below the mean
/// section of the rut, which counts as road.
void add_potholes_of_rut(const SearchInput& input, float min_cells, SearchImages& images, Candidate& rut,
                         std::vector<Candidate>& found) {
  constexpr float rut_floors = 1.3F;  // depth in depths of the rut's floor, beyond which it has a pothole: ruts vary
  constexpr double even_if_confirmed = 0.12;  // the agreement of the pictures adds up to 2 to the log-odds
  const std::size_t before = found.size();
  const Image<float> depth = images.depth;
  Image<std::uint8_t> cores(depth.width(), depth.height(), 0), road = input.road;
  input.ruts.fill(255, road);
  for (int j = 0; j < depth.height(); ++j) {
    for (int i = 0; i < depth.width(); ++i) {
      const std::size_t label = input.ruts.labels(i, j);
      if (label == 0) continue;
      const float floor_m = rut_floors * input.ruts.floors_m[label - 1];
      const float floor = input.thresholds.pixels_below(double{floor_m}, i, j);
      if (rut.cells(i, j) && depth(i, j) > floor + input.thresholds.min_depth(i, j)) cores(i, j) = 255;
      images.depth(i, j) -= input.thresholds.pixels_below(double{input.ruts.depth_m(i, j)}, i, j);
    }
  }
  const SearchInput in_rut{input.depth_cells, road, input.view, input.ruts, input.gaps, input.thresholds,
                           input.image_edges};
  for (const ConnectedComponent& core : ConnectedComponents(cores)) {
    if (static_cast<float>(core.size) < min_core_area_share * min_cells) continue;
    Candidate pothole = segment(in_rut, core, rut.kind, images);
    if (static_cast<float>(pothole.size) < min_cells || !is_measured(pothole, input.depth_cells.valid)) continue;
    add_evidence(in_rut, images, pothole);
    pothole.evidence.rut_significance = 0;
    if (confidence_at_best(pothole, input.thresholds) < even_if_confirmed) continue;
    pothole.inside = inside_rim(in_rut, images, pothole);
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
  if (static_cast<float>(core.size) < min_core_area_share * min_cells) return;
  Candidate candidate = segment(input, core, kind, images);
  if (candidate.size == 0 || static_cast<float>(candidate.size) < min_cells) return;
  if (!is_measured(candidate, input.depth_cells.valid)) return;
  add_evidence(input, images, candidate);
  const bool is_hollow = kind == DamageKind::depression && input.thresholds.metric();
  if (is_hollow && confidence_at_best(candidate, input.thresholds) < even_confidence) {
    raise_level(input, core, min_cells, images, candidate);
  }
  if (input.thresholds.metric()) leave_terrace(input, min_cells, images, candidate);
  if (confidence_at_best(candidate, input.thresholds) < min_candidate_confidence) return;
  if (candidate.evidence.rut_significance > 0) add_potholes_of_rut(input, min_cells, images, candidate, found);
  candidate.inside = inside_rim(input, images, candidate);
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
  std::erase_if(cores, [&](const ConnectedComponent& core) { return is_obstacle(input, core, kind, images); });
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
  const ViewGaps gaps = classify_gaps(depth_cells, view, thresholds);
  const SearchInput input{depth_cells, road, view, ruts, gaps, thresholds, image_edges};
  std::vector<Candidate> found;
  Image<std::uint8_t> assigned(road.width(), road.height(), 0);
  find_kind(input, DamageKind::depression, assigned, found);
  if (protrusions) find_kind(input, DamageKind::protrusion, assigned, found);
  return found;
}

}  // namespace roadstereo
