#include "damage/candidates.hpp"

#include <algorithm>
#include <optional>
#include <span>
#include <utility>

#include "core/parallel.hpp"
#include "damage/candidate_evidence.hpp"
#include "damage/candidate_search.hpp"
#include "damage/connected_components.hpp"
#include "damage/cores.hpp"
#include "damage/impossible_depths.hpp"
#include "damage/inside_rim.hpp"
#include "damage/region_levels.hpp"
#include "damage/region_segmentation.hpp"

namespace roadstereo {
namespace {

constexpr float min_core_area_share = 0.1F;  ///< of the minimum area of a damage, for its core

/// Depths, positive inside a kind of damage.
Image<float> depths_of(const Image<float>& depth, DamageKind kind) {
  Image<float> signed_depth;
  signed_depth.resize(depth.width(), depth.height());
  const float sign = sign_of(kind);
  const float* const from = depth.row(0);
  float* const to = signed_depth.row(0);
  for (std::size_t k = 0; k < depth.pixels(); ++k) to[k] = sign * from[k];
  return signed_depth;
}

/// Mask of the cells that may belong to a kind of damage.
Image<std::uint8_t> allowed_cells(const SearchInput& input, DamageKind kind, const Image<std::uint8_t>& assigned) {
  Image<std::uint8_t> mask = input.depth_cells.valid;
  std::uint8_t* const allowed = mask.row(0);
  if (kind == DamageKind::protrusion) {
    // A depression is no part of a bump beside it, nor of what surrounds that.
    const std::uint8_t depression = label_of(DamageKind::depression);
    const std::uint8_t* const labels = assigned.row(0);
    for (std::size_t k = 0; k < mask.pixels(); ++k) allowed[k] &= labels[k] == depression ? 0 : 255;
    return mask;
  }
  const std::uint8_t* const deep_gaps = input.gaps.deep.row(0);
  for (std::size_t k = 0; k < mask.pixels(); ++k) allowed[k] |= deep_gaps[k];
  return mask;
}

/// Mask of the allowed cells deeper than the threshold.
Image<std::uint8_t> core_cells(const Image<float>& depth, const Image<std::uint8_t>& allowed_cells,
                               const Thresholds& thresholds) {
  const int width = depth.width();
  Image<std::uint8_t> cores;
  cores.resize(width, depth.height());
  std::vector<float> min_depths(static_cast<std::size_t>(width));
  for (int j = 0; j < depth.height(); ++j) {
    thresholds.min_depths(j, min_depths.data());
    const float* const depths = depth.row(j);
    const float* const limits = min_depths.data();
    const std::uint8_t* const allowed = allowed_cells.row(j);
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
void add_potholes_of_rut(const SearchInput& input, float min_cells, SearchImages& images, Image<std::uint8_t>& assigned,
                         Candidate& rut, std::vector<Candidate>& found) {
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
  const SearchInput in_rut{
      input.depth_cells, road, input.view, input.ruts, input.gaps, input.coordinates, input.thresholds,
      input.image_edges};
  for (const ConnectedComponent& core : ConnectedComponents(cores)) {
    if (static_cast<float>(core.size) < min_core_area_share * min_cells) continue;
    Candidate pothole = segment(in_rut, {core}, rut.kind, images);
    if (static_cast<float>(pothole.size) < min_cells || !is_measured(pothole, input.depth_cells.valid)) continue;
    add_evidence(in_rut, images, pothole);
    pothole.evidence.rut_significance = pothole.rut_share = 0;  // the rut is road
    if (confidence_at_best(pothole, input.thresholds) < even_if_confirmed) continue;
    pothole.inside = inside_rim(in_rut, images, pothole);
    assign(pothole, assigned);
    found.push_back(std::move(pothole));
  }
  images.depth = depth;
  if (found.size() == before) return;
  update_extent(input, assigned, rut);
  if (rut.size > 0) add_evidence(input, images, rut);
}

float min_cells_at(const ConnectedComponent& core, const Thresholds& thresholds) {
  return thresholds.min_cells(core.runs.front().first, core.runs.front().row);
}

/// The candidate around a core, if the region is large enough and likely enough to be damage.
std::optional<Candidate> candidate_around(const SearchInput& input, const Core& start, DamageKind kind,
                                          SearchImages& images) {
  const ConnectedComponent& core = start.cells;
  const float min_cells = min_cells_at(core, input.thresholds);
  if (static_cast<float>(core.size) < min_core_area_share * min_cells) return {};
  Candidate candidate = segment(input, start, kind, images);
  if (candidate.size == 0 || static_cast<float>(candidate.size) < min_cells) return {};
  if (!is_measured(candidate, input.depth_cells.valid)) return {};
  add_evidence(input, images, candidate);
  const bool is_hollow = kind == DamageKind::depression && input.thresholds.metric();
  if (is_hollow && confidence_at_best(candidate, input.thresholds) < even_confidence) {
    raise_level(input, core, min_cells, images, candidate);
  }
  if (input.thresholds.metric()) leave_terrace(input, min_cells, images, candidate);
  if (confidence_at_best(candidate, input.thresholds) < min_candidate_confidence) return {};
  candidate.inside = inside_rim(input, images, candidate);
  return candidate;
}

/// Surroundings of a core, in which others may be parts of the same damage.
CellBox surroundings(const Core& core, const Image<float>& depth) {
  const CellBox& box = core.cells.box;
  return box.grown(std::max(box.columns(), box.rows()), depth.width(), depth.height());
}

/// Search for one kind of damage, from the largest core to the smallest. Threads examine the next few cores together,
/// each as if the others were no damage. Where one is, those that have read its labels are examined again, so that the
/// result is that of one after the other.
class KindSearch {
 public:
  KindSearch(const SearchInput& input, DamageKind kind, int threads, Image<std::uint8_t>& assigned)
      : input_(input),
        kind_(kind),
        threads_(threads),
        assigned_(assigned),
        depth_(depths_of(input.depth_cells.depth, kind)),
        allowed_(allowed_cells(input, kind, assigned)),
        visited_(static_cast<std::size_t>(resolve_threads(threads))) {}

  void add_candidates(std::vector<Candidate>& found) {
    constexpr std::size_t growth = 4;
    Cores all(depth_, core_cells(depth_, allowed_, input_.thresholds), input_.thresholds);
    std::vector<Core>& cores = all.cores();
    std::erase_if(cores, [&](const Core& core) {
      return !core.is_divided && is_obstacle(input_, core.cells, kind_, depth_, assigned_);
    });
    // Of cores beside each other few until one is no damage: others may be parts of the same.
    std::size_t at_once = 1;
    for (std::span<const Core> left = cores; !left.empty();) {
      SearchImages images = images_of(0);
      if (!is_assigned(left.front())) remove_outliers(input_, left.front().cells, kind_, images);
      const auto next = left.first(count_at_once(left, at_once));
      const std::size_t before = found.size(), done = accept(next, examine(next), found);
      at_once = found.size() > before ? 1 : std::min(growth * at_once, max_at_once);
      left = left.subspan(done);
    }
  }

 private:
  static constexpr std::size_t max_at_once = 16;

  struct Examined {
    std::optional<Candidate> candidate;
    CellBox labels_read;
  };

  SearchImages images_of(int worker) {
    Image<std::uint8_t>& visited = visited_[static_cast<std::size_t>(worker)];
    if (visited.empty()) visited.assign(depth_.width(), depth_.height(), 0);
    return {depth_, allowed_, visited, assigned_, {}};
  }

  /// Whether most of a core belongs to a damage, or some of one that a saddle divides from others.
  bool is_assigned(const Core& core) const {
    std::ptrdiff_t count = 0;
    for (const CellRun& run : core.cells.runs) {
      const std::uint8_t* const labels = assigned_.row(run.row);
      count += std::count_if(labels + run.first, labels + run.last + 1, [](std::uint8_t label) { return label != 0; });
    }
    return core.is_divided ? count > 0 : 2 * static_cast<std::size_t>(count) > core.cells.size;
  }

  /// Number of the first cores to examine together: `beside` that may be parts of the same damage, and more as long as
  /// they lie apart. Those after the first one have no outliers.
  std::size_t count_at_once(std::span<const Core> cores, std::size_t beside) const {
    std::size_t count = 1;
    while (count < std::min(max_at_once, cores.size()) &&
           (count < beside || lies_apart(cores[count], cores.first(count))) &&
           !has_outliers(input_, cores[count].cells, kind_, depth_)) {
      ++count;
    }
    return count;
  }

  bool lies_apart(const Core& core, std::span<const Core> others) const {
    const CellBox box = surroundings(core, depth_);
    return std::none_of(others.begin(), others.end(),
                        [&](const Core& other) { return surroundings(other, depth_).overlaps(box); });
  }

  std::vector<Examined> examine(std::span<const Core> cores) {
    std::vector<Examined> examined(cores.size());
    parallel_for(static_cast<int>(cores.size()), threads_, [&](int index, int worker) {
      const auto k = static_cast<std::size_t>(index);
      if (is_assigned(cores[k])) return;
      SearchImages images = images_of(worker);
      examined[k].candidate = candidate_around(input_, cores[k], kind_, images);
      examined[k].labels_read = images.labels_read;
    });
    return examined;
  }

  /// Adds the candidates of the first cores, up to one that has read labels which have changed since. Returns the
  /// number of these cores.
  std::size_t accept(std::span<const Core> cores, std::vector<Examined> examined, std::vector<Candidate>& found) {
    CellBox changed;
    for (std::size_t k = 0; k < cores.size(); ++k) {
      if (is_assigned(cores[k])) continue;
      if (changed.overlaps(examined[k].labels_read)) return k;
      if (!examined[k].candidate) continue;
      const std::size_t before = found.size();
      add(cores[k].cells, std::move(*examined[k].candidate), found);
      for (std::size_t n = before; n < found.size(); ++n) changed.add(found[n].box());
    }
    return cores.size();
  }

  void add(const ConnectedComponent& core, Candidate candidate, std::vector<Candidate>& found) {
    if (candidate.lies_in_rut()) {
      const float min_cells = min_cells_at(core, input_.thresholds);
      SearchImages images = images_of(0);
      add_potholes_of_rut(input_, min_cells, images, assigned_, candidate, found);
      const bool is_large = candidate.size > 0 && static_cast<float>(candidate.size) >= min_cells;
      if (!is_large || confidence_at_best(candidate, input_.thresholds) < min_candidate_confidence) return;
    }
    assign(candidate, assigned_);
    found.push_back(std::move(candidate));
  }

  const SearchInput& input_;
  DamageKind kind_;
  int threads_;
  Image<std::uint8_t>& assigned_;  ///< shared by both kinds
  Image<float> depth_;
  Image<std::uint8_t> allowed_;
  std::vector<Image<std::uint8_t>> visited_;  ///< of each worker
};

}  // namespace

std::vector<Candidate> find_candidates(DepthCells& depth_cells, const Image<std::uint8_t>& road, const CommonView& view,
                                       const Ruts& ruts, const SurfaceCoordinates& coordinates,
                                       const Thresholds& thresholds, const ImageEdges& image_edges, bool protrusions,
                                       int threads) {
  const ViewGaps gaps = classify_gaps(depth_cells, view, thresholds);
  const SearchInput input{depth_cells, road, view, ruts, gaps, coordinates, thresholds, image_edges};
  std::vector<Candidate> found;
  Image<std::uint8_t> assigned(road.width(), road.height(), 0);
  KindSearch(input, DamageKind::depression, threads, assigned).add_candidates(found);
  if (protrusions) KindSearch(input, DamageKind::protrusion, threads, assigned).add_candidates(found);
  return found;
}

}  // namespace roadstereo
