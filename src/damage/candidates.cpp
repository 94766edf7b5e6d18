#include "damage/candidates.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "damage/connected_regions.hpp"
#include "damage/contours.hpp"
#include "damage/grow.hpp"
#include "damage/outline.hpp"

namespace roadstereo {
namespace {

/// Adds to `allowed` the cells without a measurement that belong to the depressions around them: what a steep, dark
/// wall leaves. A gap that reaches the border of the picture, or lies in the road, belongs to none.
void allow_holes(const DepthCells& relief, const Thresholds& thresholds, Image<std::uint8_t>& allowed) {
  constexpr double least_share = 0.35;  // of its surroundings that is deep
  for (const ConnectedRegion& gap : ConnectedRegions(relief.known, ConnectedRegions::Of::unset)) {
    if (gap.touches_border) continue;
    int around = 0;
    int deep = 0;
    const auto look = [&](int i, int j) {
      if (relief.known(i, j) == 0) return;
      ++around;
      deep += relief.depth(i, j) > 0.5F * thresholds.depth(i, j) ? 1 : 0;
    };
    for (const CellRun& run : gap.runs) {
      look(run.first - 1, run.row);
      look(run.last + 1, run.row);
      for (int i = run.first; i <= run.last; ++i) {
        look(i, run.row - 1);
        look(i, run.row + 1);
      }
    }
    if (deep >= least_share * around) paint(gap, 255, allowed);
  }
}

/// What the cells of a damage of this kind are marked with.
std::uint8_t mark_of(DamageKind kind) {
  return kind == DamageKind::depression ? 1 : 2;
}

/// What lies around a region, within half of its radius.
struct Surroundings {
  double on_road = 0;  ///< share of the cells that lie on the road, or no deeper than the outline
  double open = 0;     ///< share of the region's rim that is the border of the picture
};

/// Share of the rim of a region that is the border of the picture.
double open_share(const BoxMask& region, int columns, int rows) {
  const Box& box = region.box();
  double rim = 0;
  double open = 0;
  for (int j = box.first_row; j <= box.last_row; ++j) {
    for (int i = box.first_column; i <= box.last_column; ++i) {
      if (!region(i, j)) continue;
      const bool at_border = i == 0 || j == 0 || i + 1 == columns || j + 1 == rows;
      if (!at_border && !on_contour(region, i, j, columns, rows)) continue;
      ++rim;
      open += at_border ? 1 : 0;
    }
  }
  return rim > 0 ? open / rim : 0;
}

Surroundings surroundings_of(const Candidate& candidate, const DepthCells& relief, const Image<std::uint8_t>& road,
                             const Image<std::uint8_t>& taken) {
  constexpr double half = 0.5;
  constexpr float hollow = 10;  // standard deviations: the bowl around a pothole is no deeper
  constexpr int least_reach = 3;
  const double radius = std::sqrt(static_cast<double>(candidate.size) / std::numbers::pi);
  const int reach = std::max(least_reach, static_cast<int>(half * radius));
  const Box around = candidate.box().grown(reach, road.width(), road.height());
  const BoxMask grown = grow(candidate.cells, reach, around);
  const float sign = sign_of(candidate.kind);
  const float bowl = candidate.kind == DamageKind::depression
                         ? std::min(candidate.level, hollow * static_cast<float>(relief.noise))
                         : 0.0F;
  double cells = 0;
  double on_road = 0;
  for (int j = around.first_row; j <= around.last_row; ++j) {
    for (int i = around.first_column; i <= around.last_column; ++i) {
      if (!grown(i, j) || candidate.cells(i, j) || taken(i, j) != 0) continue;
      ++cells;
      if (relief.known(i, j) == 0) continue;
      const float depth = sign * relief.depth(i, j);
      on_road += road(i, j) != 0 || (depth > 0 && depth <= bowl) ? 1 : 0;
    }
  }
  return {cells == 0 ? 1 : on_road / cells, open_share(candidate.cells, road.width(), road.height())};
}

class Search {
 public:
  Search(const DepthCells& relief, const Image<std::uint8_t>& road, const Thresholds& thresholds,
         const Witness& witness, DamageKind kind)
      : relief_(relief),
        road_(road),
        thresholds_(thresholds),
        witness_(witness),
        kind_(kind),
        depth_(relief.depth),
        allowed_(relief.known),
        reached_(relief.depth.width(), relief.depth.height(), 0) {
    if (kind == DamageKind::protrusion) turn_over();
    if (kind == DamageKind::depression) allow_holes(relief, thresholds, allowed_);
  }

  /// Adds what is found to `found`; cells of `taken` belong to others.
  void run(std::vector<Candidate>& found, Image<std::uint8_t>& taken) {
    const ConnectedRegions regions(cores_of_depth());
    std::vector<ConnectedRegion> cores(regions.begin(), regions.end());
    std::sort(cores.begin(), cores.end(), [](const auto& one, const auto& other) { return one.size > other.size; });
    for (const ConnectedRegion& core : cores) {
      const CellRun& first = core.runs.front();
      if (taken(first.first, first.row) == 0) add(core, found, taken);
    }
  }

 private:
  void turn_over() {
    float* const depths = depth_.row(0);
    for (std::size_t k = 0; k < depth_.pixels(); ++k) depths[k] = -depths[k];
  }

  Image<std::uint8_t> cores_of_depth() const {
    const int width = depth_.width();
    Image<std::uint8_t> cores(width, depth_.height());
    std::vector<float> least(static_cast<std::size_t>(width));
    for (int j = 0; j < depth_.height(); ++j) {
      thresholds_.depths(j, least.data());
      const float* const depths = depth_.row(j);
      const float* const limits = least.data();
      const std::uint8_t* const allowed = allowed_.row(j);
      std::uint8_t* const row = cores.row(j);
      for (int i = 0; i < width; ++i) {
        const std::uint8_t deep = depths[i] > limits[i] ? 255 : 0;
        row[i] = allowed[i] & deep;
      }
    }
    return cores;
  }

  void add(const ConnectedRegion& core, std::vector<Candidate>& found, Image<std::uint8_t>& taken) {
    constexpr double least_on_road = 0.6;
    constexpr double most_open = 0.25;
    const float least = thresholds_.least_cells(core.runs.front().first, core.runs.front().row);
    if (static_cast<float>(core.size) < 0.1F * least) return;
    Candidate candidate = draw(core, taken);
    if (candidate.size == 0 || static_cast<float>(candidate.size) < least) return;
    const Surroundings around = surroundings_of(candidate, relief_, road_, taken);
    if (around.on_road < least_on_road || around.open > most_open) return;
    const Box& box = candidate.box();
    for (int row = box.first_row; row <= box.last_row; ++row) {
      for (int column = box.first_column; column <= box.last_column; ++column) {
        if (candidate.cells(column, row)) taken(column, row) = mark_of(kind_);
      }
    }
    found.push_back(std::move(candidate));
  }

  /// No damage is as deep, or as high.
  float most_depth(const ConnectedRegion& core) const {
    const CellRun& first = core.runs.front();
    return kind_ == DamageKind::depression ? thresholds_.deepest(first.first, first.row)
                                           : thresholds_.highest(first.first, first.row);
  }

  /// The region around a core. Where it would run into another damage, only what lies deeper than the saddle between
  /// them; empty when there is none.
  Candidate draw(const ConnectedRegion& core, const Image<std::uint8_t>& taken) {
    constexpr int tries = 8;
    constexpr float deeper = 1.25F;
    constexpr float noise_floor = 2;  // standard deviations of the road
    constexpr double bowl = 2;        // a paraboloid's rim is twice as steep as the cone
    const DepthField field{depth_, allowed_, reached_};
    Candidate candidate;
    candidate.kind = kind_;
    const float floor = floor_depth(field, core);
    if (floor > most_depth(core)) return candidate;
    const Outline outline =
        find_outline(field, core, floor, noise_floor * static_cast<float>(relief_.noise), thresholds_.metric());
    if (!thresholds_.metric() && outline.steepness < bowl) return candidate;
    candidate.level = outline.level;
    for (int i = 0; i < tries; ++i, candidate.level *= deeper) {
      candidate.cells = flood(field, core, candidate.level);
      if (candidate.box().empty()) break;
      if (fill_out(field, taken, candidate)) return candidate;
    }
    candidate.size = 0;
    return candidate;
  }

  /// Grows what was flooded to the region that is measured. False when it runs into another damage.
  bool fill_out(const DepthField& field, const Image<std::uint8_t>& taken, Candidate& candidate) const {
    constexpr float foot = 0.5F;  // standard deviations of the road, where the region is known to hang together
    if (thresholds_.metric()) {
      grow_to_foot(field, candidate.level, foot * static_cast<float>(relief_.noise), candidate.cells);
    }
    fill_enclosed(candidate.cells.cells(), depth_.pixels() / 4);
    if (!measure_extent(candidate, taken)) return false;
    if (candidate.size == 0 || kind_ == DamageKind::protrusion || witness_.grey.empty()) return true;
    extend_by_image(witness_, depth_.width(), depth_.height(), candidate.cells);
    fill_enclosed(candidate.cells.cells(), depth_.pixels() / 4);
    return measure_extent(candidate, taken);
  }

  /// Box and size. False when the region has cells of another damage of its kind; those of the other kind it gives up.
  static bool measure_extent(Candidate& candidate, const Image<std::uint8_t>& taken) {
    const Box around = candidate.box();
    Box box;
    candidate.size = 0;
    for (int j = around.first_row; j <= around.last_row; ++j) {
      for (int i = around.first_column; i <= around.last_column; ++i) {
        if (!candidate.cells(i, j)) continue;
        if (taken(i, j) == mark_of(candidate.kind)) return false;
        if (taken(i, j) != 0) {
          candidate.cells.set(i, j, false);
          continue;
        }
        box.add(i, j);
        ++candidate.size;
      }
    }
    candidate.cells = candidate.cells.within(box);
    return true;
  }

  const DepthCells& relief_;
  const Image<std::uint8_t>& road_;
  const Thresholds& thresholds_;
  const Witness& witness_;
  DamageKind kind_;
  Image<float> depth_;  ///< positive inside the kind of damage that is looked for
  Image<std::uint8_t> allowed_;
  Image<std::uint8_t> reached_;  ///< scratch of floods
};

}  // namespace

std::vector<Candidate> find_candidates(const DepthCells& relief, const Image<std::uint8_t>& road,
                                       const Thresholds& thresholds, const Witness& witness, bool protrusions) {
  std::vector<Candidate> found;
  Image<std::uint8_t> taken(relief.depth.width(), relief.depth.height(), 0);
  Search(relief, road, thresholds, witness, DamageKind::depression).run(found, taken);
  if (protrusions) Search(relief, road, thresholds, witness, DamageKind::protrusion).run(found, taken);
  return found;
}

}  // namespace roadstereo
