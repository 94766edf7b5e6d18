#include "damage/candidates.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "damage/image_outline.hpp"
#include "damage/outline.hpp"

namespace roadstereo {
namespace {

/// Cells without a measurement that belong to the depressions around them: what a steep, dark wall leaves. A gap that
/// reaches the border of the picture, or lies in the road, belongs to none.
Image<std::uint8_t> holes_of(const Image<float>& depth, const Image<std::uint8_t>& known,
                             const Thresholds& thresholds) {
  constexpr double least_share = 0.35;  // of its surroundings that is deep
  Image<std::uint8_t> gaps(known.width(), known.height());
  for (int j = 0; j < known.height(); ++j) {
    for (int i = 0; i < known.width(); ++i) gaps(i, j) = known(i, j) == 0 ? 255 : 0;
  }
  Image<std::uint8_t> holes(known.width(), known.height(), 0);
  for (const ConnectedRegion& gap : connected_regions(gaps)) {
    if (gap.touches_border) continue;
    int around = 0;
    int deep = 0;
    const auto look = [&](int i, int j) {
      if (known(i, j) == 0) return;
      ++around;
      deep += depth(i, j) > 0.5F * thresholds.depth(i, j) ? 1 : 0;
    };
    for (const std::int32_t cell : gap.cells) {
      const int i = cell % known.width();
      const int j = cell / known.width();
      look(i - 1, j);
      look(i + 1, j);
      look(i, j - 1);
      look(i, j + 1);
    }
    if (deep < least_share * around) continue;
    for (const std::int32_t cell : gap.cells) holes(cell % known.width(), cell / known.width()) = 255;
  }
  return holes;
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
double open_share(const Image<std::uint8_t>& region, const Box& box) {
  const int right = region.width() - 1;
  const int bottom = region.height() - 1;
  double rim = 0;
  double open = 0;
  for (int j = box.first_row; j <= box.last_row; ++j) {
    for (int i = box.first_column; i <= box.last_column; ++i) {
      if (region(i, j) == 0) continue;
      const bool at_border = i == 0 || j == 0 || i == right || j == bottom;
      if (!at_border && region(i - 1, j) != 0 && region(i + 1, j) != 0 && region(i, j - 1) != 0 &&
          region(i, j + 1) != 0) {
        continue;
      }
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
  const Box around = candidate.box.grown(reach, road.width(), road.height());
  const Image<std::uint8_t> grown = grow(candidate.cells, reach, around);
  const float sign = sign_of(candidate.kind);
  const float bowl = candidate.kind == DamageKind::depression
                         ? std::min(candidate.level, hollow * static_cast<float>(relief.noise))
                         : 0.0F;
  double cells = 0;
  double on_road = 0;
  for (int j = around.first_row; j <= around.last_row; ++j) {
    for (int i = around.first_column; i <= around.last_column; ++i) {
      if (grown(i, j) == 0 || candidate.cells(i, j) != 0 || taken(i, j) != 0) continue;
      ++cells;
      if (relief.known(i, j) == 0) continue;
      const float depth = sign * relief.depth(i, j);
      on_road += road(i, j) != 0 || (depth > 0 && depth <= bowl) ? 1 : 0;
    }
  }
  if (cells == 0) return {1, open_share(candidate.cells, candidate.box)};
  return {on_road / cells, open_share(candidate.cells, candidate.box)};
}

class Search {
 public:
  Search(const DepthCells& relief, const Image<std::uint8_t>& road, const Thresholds& thresholds,
         const Witness& witness, DamageKind kind)
      : relief_(relief), road_(road), thresholds_(thresholds), witness_(witness), kind_(kind), depth_(relief.depth) {
    if (kind == DamageKind::protrusion) turn_over();
    allowed_ = relief.known;
    if (kind == DamageKind::depression) allow(holes_of(depth_, relief.known, thresholds));
  }

  /// Adds what is found to `found`; cells of `taken` belong to others.
  void run(std::vector<Candidate>& found, Image<std::uint8_t>& taken) const {
    std::vector<ConnectedRegion> cores = connected_regions(cores_of_depth());
    std::sort(cores.begin(), cores.end(),
              [](const auto& one, const auto& other) { return one.cells.size() > other.cells.size(); });
    for (const ConnectedRegion& core : cores) {
      const int i = core.cells.front() % depth_.width();
      const int j = core.cells.front() / depth_.width();
      if (taken(i, j) != 0) continue;
      add(core, found, taken);
    }
  }

 private:
  void turn_over() {
    for (int j = 0; j < depth_.height(); ++j) {
      for (int i = 0; i < depth_.width(); ++i) depth_(i, j) = -depth_(i, j);
    }
  }

  void allow(const Image<std::uint8_t>& holes) {
    for (int j = 0; j < holes.height(); ++j) {
      for (int i = 0; i < holes.width(); ++i) {
        if (holes(i, j) != 0) allowed_(i, j) = 255;
      }
    }
  }

  Image<std::uint8_t> cores_of_depth() const {
    Image<std::uint8_t> cores(depth_.width(), depth_.height());
    for (int j = 0; j < depth_.height(); ++j) {
      for (int i = 0; i < depth_.width(); ++i) {
        cores(i, j) = allowed_(i, j) != 0 && depth_(i, j) > thresholds_.depth(i, j) ? 255 : 0;
      }
    }
    return cores;
  }

  void add(const ConnectedRegion& core, std::vector<Candidate>& found, Image<std::uint8_t>& taken) const {
    constexpr double least_on_road = 0.6;
    constexpr double most_open = 0.25;
    const int i = core.cells.front() % depth_.width();
    const int j = core.cells.front() / depth_.width();
    const float least = thresholds_.least_cells(i, j);
    if (static_cast<float>(core.cells.size()) < 0.1F * least) return;
    Candidate candidate = draw(core, taken);
    if (candidate.size == 0 || static_cast<float>(candidate.size) < least) return;
    const Surroundings around = surroundings_of(candidate, relief_, road_, taken);
    if (around.on_road < least_on_road || around.open > most_open) return;
    for (int row = candidate.box.first_row; row <= candidate.box.last_row; ++row) {
      for (int column = candidate.box.first_column; column <= candidate.box.last_column; ++column) {
        if (candidate.cells(column, row) != 0) taken(column, row) = mark_of(kind_);
      }
    }
    found.push_back(std::move(candidate));
  }

  /// The region around a core. Where it would run into another damage, only what lies deeper than the saddle between
  /// them; empty when there is none.
  Candidate draw(const ConnectedRegion& core, const Image<std::uint8_t>& taken) const {
    constexpr int tries = 8;
    constexpr float deeper = 1.25F;
    constexpr float noise_floor = 2;  // standard deviations of the road
    constexpr float foot = 0.5F;      // likewise, where the region is known to hang together
    constexpr double bowl = 2;        // a paraboloid's rim is twice as steep as the cone
    const DepthField field{depth_, allowed_};
    Candidate candidate;
    candidate.kind = kind_;
    const Outline outline =
        find_outline(field, core.cells, noise_floor * static_cast<float>(relief_.noise), thresholds_.metric);
    if (!thresholds_.metric && outline.steepness < bowl) return candidate;
    const std::int32_t first = core.cells.front();
    const Image<float>& largest = kind_ == DamageKind::depression ? thresholds_.deepest : thresholds_.highest;
    if (outline.floor > largest(first % depth_.width(), first / depth_.width())) return candidate;
    candidate.level = outline.level;
    for (int i = 0; i < tries; ++i, candidate.level *= deeper) {
      candidate.cells = flood(field, core.cells, candidate.level, whole(depth_));
      if (thresholds_.metric) {
        grow_to_foot(field, candidate.level, foot * static_cast<float>(relief_.noise), candidate.cells);
      }
      fill_enclosed(candidate.cells, whole(depth_), depth_.pixels() / 4);
      if (!measure_extent(candidate, taken)) continue;
      if (kind_ == DamageKind::depression && !witness_.grey.empty()) {
        extend_by_image(witness_.grey, witness_.reach, candidate.box, candidate.cells);
        fill_enclosed(candidate.cells, whole(depth_), depth_.pixels() / 4);
        if (!measure_extent(candidate, taken)) continue;
      }
      return candidate;
    }
    candidate.size = 0;
    return candidate;
  }

  /// Box and size. False when the region has cells of another damage of its kind; those of the other kind it gives up.
  static bool measure_extent(Candidate& candidate, const Image<std::uint8_t>& taken) {
    candidate.box = {};
    candidate.size = 0;
    for (int j = 0; j < taken.height(); ++j) {
      for (int i = 0; i < taken.width(); ++i) {
        if (candidate.cells(i, j) == 0) continue;
        if (taken(i, j) == mark_of(candidate.kind)) return false;
        if (taken(i, j) != 0) {
          candidate.cells(i, j) = 0;
          continue;
        }
        candidate.box.add(i, j);
        ++candidate.size;
      }
    }
    return true;
  }

  const DepthCells& relief_;
  const Image<std::uint8_t>& road_;
  const Thresholds& thresholds_;
  const Witness& witness_;
  DamageKind kind_;
  Image<float> depth_;  ///< positive inside the kind of damage that is looked for
  Image<std::uint8_t> allowed_;
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
