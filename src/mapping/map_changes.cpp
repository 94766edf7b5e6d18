#include "roadstereo/map_changes.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/order_statistics.hpp"
#include "mapping/footprints.hpp"

namespace roadstereo {
namespace {

constexpr double min_std_errors = 2;

/// Cells of two maps around a footprint, read strip by strip: a rut is long.
class PlacePair {
 public:
  PlacePair(const MapCells& footprint, const RoadMap& before, const RoadMap& after) : before_(before), after_(after) {
    constexpr int strip_rows = 128;
    const int first_row = footprint.front()[1] - band, last_row = footprint.back()[1] + band;
    for (int row = first_row; row <= last_row; row += strip_rows) {
      add_strip(footprint, row, std::min(row + strip_rows - 1, last_row));
    }
    share_ = static_cast<double>(inside_.size()) / static_cast<double>(footprint.size());
  }

  /// Whether both maps measure at least half of the footprint.
  bool is_measured() const {
    constexpr double min_share = 0.5;
    return share_ >= min_share;
  }

  /// Absent if the footprint is not measured, or nothing around it.
  std::optional<Measurement> change() const {
    if (!is_measured() || around_.empty()) return std::nullopt;
    double sum = 0;
    for (const double difference : inside_) sum += difference;
    std::vector<double> around = around_;
    const auto n = static_cast<double>(inside_.size());
    return Measurement{sum / n - upper_median(around), std::sqrt(variances_ / n)};
  }

 private:
  static constexpr int band = 5;  ///< around the footprint, 0.1 m

  struct Seen {
    double height, variance;
  };

  /// Cells of one map.
  struct Place {
    double cell_m;
    MapRaster raster;

    Place(const RoadMap& map, int column0, int row0, int column1, int row1) : cell_m(map.options().cell_m) {
      const auto cell = [&](int index) { return static_cast<int>(std::floor(index * footprint_m / cell_m)); };
      raster =
          map.read({cell(column0), cell(row0), cell(column1 + 1) - cell(column0) + 1, cell(row1 + 1) - cell(row0) + 1});
    }

    std::optional<Seen> look(int column, int row) const {
      const auto cell = [&](int index) { return static_cast<int>(std::floor((index + 0.5) * footprint_m / cell_m)); };
      const int u = cell(column) - raster.box.i0, v = raster.box.j0 + raster.box.rows - 1 - cell(row);
      if (raster.views(u, v) == 0) return std::nullopt;
      const double sigma = raster.sigma(u, v);
      return Seen{raster.height(u, v), sigma * sigma};
    }
  };

  /// Add the cells of the rows `row0` … `row1`.
  void add_strip(const MapCells& footprint, int row0, int row1) {
    const auto from = [&](int row) {
      return std::partition_point(footprint.begin(), footprint.end(), [row](const auto& c) { return c[1] < row; });
    };
    const auto first = from(row0 - band), last = from(row1 + band + 1);
    if (first == last) return;
    const auto [left, right] =
        std::minmax_element(first, last, [](const auto& a, const auto& b) { return a[0] < b[0]; });
    const int column0 = (*left)[0] - band, column1 = (*right)[0] + band;
    // 2 in the footprint, 1 in the band around it
    Image<std::uint8_t> part(column1 - column0 + 1, row1 - row0 + 1, 0);
    for (auto cell = first; cell != last; ++cell) {
      const auto [column, row] = *cell;
      for (int y = std::max(row - band, row0); y <= std::min(row + band, row1); ++y) {
        std::fill_n(part.row(y - row0) + column - column0 - band, 2 * band + 1, std::uint8_t{1});
      }
    }
    for (auto cell = from(row0); cell != from(row1 + 1); ++cell) part((*cell)[0] - column0, (*cell)[1] - row0) = 2;
    const Place before(before_, column0, row0, column1, row1), after(after_, column0, row0, column1, row1);
    for (int y = 0; y < part.height(); ++y) {
      for (int x = 0; x < part.width(); ++x) {
        if (part(x, y) > 0) add(before.look(column0 + x, row0 + y), after.look(column0 + x, row0 + y), part(x, y) == 2);
      }
    }
  }

  void add(const std::optional<Seen>& before, const std::optional<Seen>& after, bool inside) {
    if (!before || !after) return;
    (inside ? inside_ : around_).push_back(after->height - before->height);
    if (inside) variances_ += before->variance + after->variance;
  }

  const RoadMap &before_, &after_;
  std::vector<double> inside_, around_;  ///< later minus earlier heights
  double variances_ = 0, share_ = 0;
};

/// By how many standard errors a figure grew; 0 for less than two.
double growth(const Measurement& before, const Measurement& after) {
  const double ratio = (after.value - before.value) / std::hypot(before.std_error, after.std_error);
  return std::abs(ratio) > min_std_errors ? ratio : 0;
}

/// By how many standard errors the heights moved away from the road; 0 for less than two.
double growth(DamageKind kind, const Measurement& height_change) {
  const double away = kind == DamageKind::depression ? -height_change.value : height_change.value;
  return growth({0, 0}, {away, height_change.std_error});
}

/// Heights, which are known best, decide before depth and area.
std::optional<DamageChangeKind> change_of(const RoadDamageRecord& before, const RoadDamageRecord& after,
                                          const Measurement& height_change) {
  for (const double grown : {growth(after.best.damage.kind, height_change),
                             growth(before.max_depth_m, after.max_depth_m), growth(before.area_m2, after.area_m2)}) {
    if (grown != 0) return grown > 0 ? DamageChangeKind::grown : DamageChangeKind::reduced;
  }
  return std::nullopt;
}

/// Index of the record of the same damage with the largest overlap.
std::optional<std::size_t> partner_of(const RoadDamageRecord& record, std::span<const RoadDamageRecord> others) {
  std::optional<std::size_t> partner;
  double max_share = min_overlap_share;
  for (std::size_t k = 0; k < others.size(); ++k) {
    if (others[k].best.damage.kind != record.best.damage.kind) continue;
    const double share = overlap_share(record.best.footprint, others[k].best.footprint);
    if (share < max_share) continue;
    max_share = share;
    partner = k;
  }
  return partner;
}

/// Change of the heights in the footprint of a record; none where one of the maps does not measure it.
std::optional<Measurement> height_change(const RoadDamageRecord& record, const RoadMap& before, const RoadMap& after) {
  if (record.best.footprint.empty()) return std::nullopt;
  return PlacePair(record.best.footprint, before, after).change();
}

}  // namespace

const char* name_of(DamageChangeKind kind) {
  switch (kind) {
    case DamageChangeKind::appeared:
      return "new";
    case DamageChangeKind::grown:
      return "grown";
    case DamageChangeKind::reduced:
      return "reduced";
    case DamageChangeKind::repaired:
      break;
  }
  return "repaired";
}

bool measures(const RoadMap& map, const MapCells& footprint) {
  return !footprint.empty() && PlacePair(footprint, map, map).is_measured();
}

bool is_superseded(const RoadDamageRecord& before, const RoadMap& map_before, std::span<const RoadDamageRecord> after,
                   const RoadMap& map_after) {
  if (partner_of(before, after)) return true;
  const auto moved = height_change(before, map_before, map_after);
  const double towards_road = !moved                                              ? 0
                              : before.best.damage.kind == DamageKind::depression ? moved->value
                                                                                  : -moved->value;
  return moved && towards_road > 0.5 * before.mean_depth_m.value;
}

std::vector<DamageChange> compare_damage(std::span<const RoadDamageRecord> before, const RoadMap& map_before,
                                         std::span<const RoadDamageRecord> after, const RoadMap& map_after) {
  std::vector<DamageChange> changes;
  for (std::size_t k = 0; k < after.size(); ++k) {
    const auto moved = height_change(after[k], map_before, map_after);
    if (!moved) continue;
    const std::optional<std::size_t> partner = partner_of(after[k], before);
    if (partner) {
      const auto kind = change_of(before[*partner], after[k], *moved);
      if (kind) changes.push_back({*kind, partner, k, *moved});
    } else if (growth(after[k].best.damage.kind, *moved) > 0) {
      changes.push_back({DamageChangeKind::appeared, std::nullopt, k, *moved});
    }
  }
  for (std::size_t k = 0; k < before.size(); ++k) {
    if (partner_of(before[k], after)) continue;
    const auto moved = height_change(before[k], map_before, map_after);
    if (moved && growth(before[k].best.damage.kind, *moved) < 0) {
      changes.push_back({DamageChangeKind::repaired, k, std::nullopt, *moved});
    }
  }
  return changes;
}

}  // namespace roadstereo
