#include "synth/damage_truth.hpp"

#include <algorithm>
#include <cmath>

#include "core/parallel.hpp"

namespace roadstereo::synth {
namespace {

struct Interval {
  double lower;
  double upper;
};

/// Sums over the grid points of one damage.
class GridSums {
 public:
  GridSums(const HeightField& field, int id, double step) : field_(field), id_(id), step_(step) {}

  void add_row(double y, const Interval& interval) {
    // The grid does not depend on the interval, so that adjacent intervals neither overlap nor leave gaps.
    const auto first = static_cast<std::int64_t>(std::ceil(interval.lower / step_ - 0.5));
    for (std::int64_t i = first; (static_cast<double>(i) + 0.5) * step_ < interval.upper; ++i) {
      add_point((static_cast<double>(i) + 0.5) * step_, y);
    }
  }

  DamageTruth result(const char* kind) const {
    DamageTruth truth;
    truth.id = id_;
    truth.kind = kind;
    if (points_ == 0) return truth;
    const auto n = static_cast<double>(points_);
    truth.x_m = sum_x_ / n;
    truth.y_m = sum_y_ / n;
    truth.depth_m = max_depth_;
    truth.mean_depth_m = sum_depth_ / n;
    truth.area_m2 = n * step_ * step_;
    truth.volume_m3 = sum_depth_ * step_ * step_;
    return truth;
  }

 private:
  void add_point(double x, double y) {
    if (field_.damage_id(x, y) != id_) return;
    const double depth = std::abs(field_.damage(x, y).offset);
    ++points_;
    sum_x_ += x;
    sum_y_ += y;
    sum_depth_ += depth;
    max_depth_ = std::max(max_depth_, depth);
  }

  const HeightField& field_;
  int id_;
  double step_;
  std::int64_t points_ = 0;
  double sum_x_ = 0;
  double sum_y_ = 0;
  double sum_depth_ = 0;
  double max_depth_ = 0;
};

/// Rows of a grid over a box: the centres of strips of height `step`.
std::vector<double> grid_rows(const AxisAlignedBox& box, double step) {
  std::vector<double> rows(static_cast<std::size_t>(std::ceil((box.upper.y - box.lower.y) / step)));
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = box.lower.y + (static_cast<double>(i) + 0.5) * step;
  return rows;
}

DamageTruth measure_blob(const HeightField& field, int id, const Blob& blob) {
  constexpr int columns = 500;
  const AxisAlignedBox& box = field.pieces()[static_cast<std::size_t>(id - 1)].box;
  const double step = (box.upper.x - box.lower.x) / columns;
  GridSums sums(field, id, step);
  for (const double y : grid_rows(box, step)) sums.add_row(y, {box.lower.x, box.upper.x});
  return sums.result(blob.depth_m > 0 ? "pothole" : "bump");
}

/// Interval of row y that contains the groove of a segment; empty (lower > upper) if the row misses it.
Interval groove_interval(const CrackShape::Segment& segment, double y, double half_width) {
  double first = 0;
  double last = 1;
  if (segment.dy != 0) {
    const double a = (y - half_width - segment.y) / segment.dy;
    const double b = (y + half_width - segment.y) / segment.dy;
    first = std::max(first, std::min(a, b));
    last = std::min(last, std::max(a, b));
  } else if (std::abs(y - segment.y) > half_width) {
    return {1, 0};
  }
  if (first > last) return {1, 0};
  const double xa = segment.x + first * segment.dx;
  const double xb = segment.x + last * segment.dx;
  return {std::min(xa, xb) - half_width, std::max(xa, xb) + half_width};
}

/// Disjoint intervals of row y that contain the grooves of all segments.
std::vector<Interval> groove_intervals(const CrackShape& crack, double y) {
  const double half_width = crack.crack().width_m / 2;
  std::vector<Interval> intervals;
  for (const CrackShape::Segment& segment : crack.segments()) {
    const Interval interval = groove_interval(segment, y, half_width);
    if (interval.lower <= interval.upper) intervals.push_back(interval);
  }
  std::sort(intervals.begin(), intervals.end(), [](const Interval& a, const Interval& b) { return a.lower < b.lower; });
  std::vector<Interval> merged;
  for (const Interval& interval : intervals) {
    if (!merged.empty() && interval.lower <= merged.back().upper) {
      merged.back().upper = std::max(merged.back().upper, interval.upper);
    } else {
      merged.push_back(interval);
    }
  }
  return merged;
}

DamageTruth measure_crack(const HeightField& field, int id) {
  const HeightField::Piece& piece = field.pieces()[static_cast<std::size_t>(id - 1)];
  const double step = piece.crack->crack().width_m / 16;
  GridSums sums(field, id, step);
  for (const double y : grid_rows(piece.box, step)) {
    for (const Interval& interval : groove_intervals(*piece.crack, y)) sums.add_row(y, interval);
  }
  return sums.result("crack");
}

/// Interval of row y that contains a rut.
Interval rut_interval(const HeightField::Piece& piece, double y) {
  const Interval box{piece.box.lower.x, piece.box.upper.x};
  const Rut& rut = piece.rut->rut();
  const double dx = rut.to_m[0] - rut.from_m[0], dy = rut.to_m[1] - rut.from_m[1];
  if (std::abs(dy) < std::abs(dx)) return box;
  const double middle = rut.from_m[0] + (y - rut.from_m[1]) * dx / dy;
  const double half_width = 0.5 * rut.width_m * std::hypot(dx, dy) / std::abs(dy);
  return {std::max(box.lower, middle - half_width), std::min(box.upper, middle + half_width)};
}

DamageTruth measure_rut(const HeightField& field, int id) {
  constexpr int columns = 32;  // of its width
  const HeightField::Piece& piece = field.pieces()[static_cast<std::size_t>(id - 1)];
  const double step = piece.rut->rut().width_m / columns;
  GridSums sums(field, id, step);
  for (const double y : grid_rows(piece.box, step)) sums.add_row(y, rut_interval(piece, y));
  return sums.result("rut");
}

}  // namespace

std::vector<DamageTruth> measure_damages(const HeightField& field, const Road& road, int threads) {
  const auto count = static_cast<int>(field.pieces().size());
  std::vector<DamageTruth> truths(field.pieces().size());
  parallel_for(count, threads, [&](int i, int) {
    const auto index = static_cast<std::size_t>(i);
    truths[index] = index < road.blobs.size()     ? measure_blob(field, i + 1, road.blobs[index])
                    : field.pieces()[index].crack ? measure_crack(field, i + 1)
                                                  : measure_rut(field, i + 1);
  });
  std::erase_if(truths, [&road](const DamageTruth& truth) {
    const auto index = static_cast<std::size_t>(truth.id - 1);
    return index < road.blobs.size() && !road.blobs[index].is_damage;
  });
  return truths;
}

}  // namespace roadstereo::synth
