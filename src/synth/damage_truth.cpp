#include "synth/damage_truth.hpp"

#include <algorithm>
#include <cmath>

#include "core/parallel.hpp"

namespace roadstereo::synth {
namespace {

struct Range {
  double low;
  double high;
};

/// Sums over the grid points of one damage.
class Sums {
 public:
  Sums(const HeightField& field, int id, double step) : field_(field), id_(id), step_(step) {}

  void add_row(double y, const Range& range) {
    // Points lie on one grid whatever the ranges are, so that neighbouring ranges neither overlap nor leave
    // gaps.
    const auto first = static_cast<std::int64_t>(std::ceil(range.low / step_ - 0.5));
    for (std::int64_t i = first; (static_cast<double>(i) + 0.5) * step_ < range.high; ++i) {
      add_point((static_cast<double>(i) + 0.5) * step_, y);
    }
  }

  DamageTruth result(const char* kind) const {
    DamageTruth truth;
    truth.id = id_;
    truth.kind = kind;
    if (points_ == 0) return truth;
    const auto n = static_cast<double>(points_);
    truth.x_m = x_ / n;
    truth.y_m = y_ / n;
    truth.depth_m = largest_;
    truth.mean_depth_m = depth_ / n;
    truth.area_m2 = n * step_ * step_;
    truth.volume_m3 = depth_ * step_ * step_;
    return truth;
  }

 private:
  void add_point(double x, double y) {
    if (field_.damage_id(x, y) != id_) return;
    const double depth = std::abs(field_.damage(x, y).offset);
    ++points_;
    x_ += x;
    y_ += y;
    depth_ += depth;
    largest_ = std::max(largest_, depth);
  }

  const HeightField& field_;
  int id_;
  double step_;
  std::int64_t points_ = 0;
  double x_ = 0;
  double y_ = 0;
  double depth_ = 0;
  double largest_ = 0;
};

/// Middles of the rows that cut a box into strips of height `step`.
std::vector<double> rows_of(const Box& box, double step) {
  std::vector<double> rows(static_cast<std::size_t>(std::ceil((box.high.y - box.low.y) / step)));
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = box.low.y + (static_cast<double>(i) + 0.5) * step;
  return rows;
}

DamageTruth measure_blob(const HeightField& field, int id, const Blob& blob) {
  constexpr int cells = 500;
  const Box& box = field.pieces()[static_cast<std::size_t>(id - 1)].box;
  const double step = (box.high.x - box.low.x) / cells;
  Sums sums(field, id, step);
  for (const double y : rows_of(box, step)) sums.add_row(y, {box.low.x, box.high.x});
  return sums.result(blob.depth_m > 0 ? "pothole" : "bump");
}

/// The stretch of a row that a segment's groove can reach; empty (low > high) when it passes by.
Range groove_range(const CrackShape::Segment& segment, double y, double reach) {
  double first = 0;
  double last = 1;
  if (segment.dy != 0) {
    const double a = (y - reach - segment.y) / segment.dy;
    const double b = (y + reach - segment.y) / segment.dy;
    first = std::max(first, std::min(a, b));
    last = std::min(last, std::max(a, b));
  } else if (std::abs(y - segment.y) > reach) {
    return {1, 0};
  }
  if (first > last) return {1, 0};
  const double xa = segment.x + first * segment.dx;
  const double xb = segment.x + last * segment.dx;
  return {std::min(xa, xb) - reach, std::max(xa, xb) + reach};
}

std::vector<Range> groove_ranges(const CrackShape& crack, double y) {
  const double reach = crack.crack().width_m / 2;
  std::vector<Range> ranges;
  for (const CrackShape::Segment& segment : crack.segments()) {
    const Range range = groove_range(segment, y, reach);
    if (range.low <= range.high) ranges.push_back(range);
  }
  std::sort(ranges.begin(), ranges.end(), [](const Range& a, const Range& b) { return a.low < b.low; });
  std::vector<Range> merged;
  for (const Range& range : ranges) {
    if (!merged.empty() && range.low <= merged.back().high) {
      merged.back().high = std::max(merged.back().high, range.high);
    } else {
      merged.push_back(range);
    }
  }
  return merged;
}

DamageTruth measure_crack(const HeightField& field, int id) {
  const HeightField::Piece& piece = field.pieces()[static_cast<std::size_t>(id - 1)];
  const double step = piece.crack->crack().width_m / 16;
  Sums sums(field, id, step);
  for (const double y : rows_of(piece.box, step)) {
    for (const Range& range : groove_ranges(*piece.crack, y)) sums.add_row(y, range);
  }
  return sums.result("crack");
}

}  // namespace

std::vector<DamageTruth> measure_damages(const HeightField& field, const Road& road, int threads) {
  const auto count = static_cast<int>(field.pieces().size());
  std::vector<DamageTruth> truths(field.pieces().size());
  parallel_for(count, threads, [&](int i, int) {
    const auto place = static_cast<std::size_t>(i);
    truths[place] =
        place < road.blobs.size() ? measure_blob(field, i + 1, road.blobs[place]) : measure_crack(field, i + 1);
  });
  return truths;
}

}  // namespace roadstereo::synth
