#include "odometry/alignment_equations.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>

#include "core/parallel.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "odometry/alignment_equations.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for every instruction set
//
#include <hwy/highway.h>

#include "odometry/point_lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace roadstereo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Some lanes of a block of equations, as many as a vector has.
class BlockLanes {
 public:
  BlockLanes(EquationBlock& block, std::size_t first, hn::Mask<Doubles> valid)
      : block_(block), first_(first), valid_(valid) {
    Numbers ones;
    ones.store(hn::IfThenElseZero(valid_, all(1)));
    for (std::size_t i = 0; i < hn::Lanes(Doubles()); ++i) block_.valid[first_ + i] = ones.at[i] != 0;
  }

  HWY_INLINE void put(std::size_t index, Double derivatives) { store(block_.row[index], derivatives); }
  HWY_INLINE void put_residual(Double residuals) { store(block_.residual, residuals); }
  HWY_INLINE void put_variance(Double variances) {
    hn::Store(hn::IfThenElse(valid_, variances, all(1)), Doubles(), block_.variance.data() + first_);
  }
  /// Derivatives by a translation and a rotation of q.
  HWY_INLINE void put_motion(const Vectors& by_q, const Vectors& q) {
    const Vectors by_rotation = cross(q, by_q);
    put(0, by_q.x);
    put(1, by_q.y);
    put(2, by_q.z);
    put(3, by_rotation.x);
    put(4, by_rotation.y);
    put(5, by_rotation.z);
  }

 private:
  HWY_INLINE void store(EquationBlock::Lanes& lanes, Double values) {
    hn::Store(hn::IfThenElseZero(valid_, values), Doubles(), lanes.data() + first_);
  }

  EquationBlock& block_;
  std::size_t first_;
  hn::Mask<Doubles> valid_;
};

/// Points of the reference at the present motion.
struct MovedPoints {
  Vectors q;    ///< in the current camera frame, metres
  Double u, v;  ///< their pixels
  Double pixels_per_m;
  Double z;  ///< of the reference, metres
  Double disparity, shape;
  Vectors by_disparity, by_shutter;  ///< derivatives of q
  hn::Mask<Doubles> in_front;
};

// Velocity of points at the end of a motion that was a constant one, per duration of the motion: shift + turn × q.

HWY_INLINE Vector<3> turn_of(const RigidMotion& motion) {
  const Twist twist = twist_of(motion);
  return {twist[3], twist[4], twist[5]};
}

HWY_INLINE Vector<3> shift_of(const RigidMotion& motion) {
  const Vector<3> bend = roadstereo::cross(turn_of(motion), motion.translation);
  Vector<3> shift = motion.translation;
  for (std::size_t i = 0; i < 3; ++i) shift[i] -= bend[i] / 2;
  return shift;
}

class Linearisation {
 public:
  Linearisation(const LinkMaps& current, const StereoCalibration& calibration, int level, const AlignmentState& state)
      : current_(current),
        calibration_(calibration),
        state_(state),
        grey_(current.pyramid.level(level)),
        scale_(1.0 / (1 << level)),
        focal_(all(calibration.focal_px)),
        depth_scale_(all(calibration.focal_px * calibration.baseline_m)),
        turn_(all(turn_of(state.motion))),
        shift_(all(shift_of(state.motion))) {}

  /// The equations of the points from `first` on, as many as a vector has. Adds the area of each that is seen to its
  /// lane.
  void add(const std::vector<ReferencePoint>& points, std::size_t first, EquationBlock& grey, EquationBlock& disparity,
           EquationBlock::Lanes& visible) {
    const std::size_t lane = first % EquationBlock::lanes;
    batch_.read(points, first);
    const MovedPoints moved = move();
    Numbers u, v, in_front;
    u.store(moved.u);
    v.store(moved.v);
    in_front.store(hn::IfThenElseZero(moved.in_front, all(1)));
    batch_.look(grey_, scale_, u, v, in_front);
    const auto given = hn::FirstN(Doubles(), std::max(points.size(), first) - first);
    const auto seen = hn::And(given, hn::Gt(batch_.has_sample.load(), all(0)));
    compare_grey_levels(moved, BlockLanes(grey, lane, seen));
    compare_disparities(moved, seen, lane, disparity);
    for (std::size_t i = 0; i < hn::Lanes(Doubles()); ++i) {
      grey.cell[lane + i] = disparity.cell[lane + i] = points[std::min(first + i, points.size() - 1)].cell;
    }
    const Double scale = hn::Div(moved.z, moved.q.z);
    Numbers area;
    area.store(hn::IfThenElseZero(seen, hn::Min(all(1), hn::Mul(scale, scale))));
    for (std::size_t i = 0; i < hn::Lanes(Doubles()); ++i) visible[lane + i] += area.at[i];
  }

 private:
  /// `offset_shape` (direct_alignment.hpp) of the points.
  HWY_INLINE Double shape_of_offset(Double u, Double disparity) const {
    const Double right_cx = all(calibration_.cx_px + calibration_.disparity_offset_px);
    const Double x = hn::Div(hn::Sub(hn::Sub(u, disparity), right_cx), focal_);
    return hn::MulAdd(x, x, all(1));
  }

  /// Offset of the disparity where the shape of an offset has a value, that of the calibration included.
  HWY_INLINE Double offset(Double shape) const {
    return hn::MulAdd(all(state_.offset_px), shape,
                      hn::MulAdd(all(state_.growth_px), hn::Sub(shape, all(1)), all(calibration_.disparity_offset_px)));
  }

  HWY_INLINE MovedPoints move() const {
    constexpr double min_depth_m = 0.05;
    const Double u = batch_.u.load(), v = batch_.v.load(), measured = batch_.disparity.load();
    const Double shape = shape_of_offset(u, measured), disparity = hn::Add(measured, offset(shape));
    auto valid = hn::Gt(disparity, all(0));
    const Double z = hn::Div(depth_scale_, disparity), per_focal = hn::Div(z, focal_);
    const Vectors p{hn::Mul(hn::Sub(u, all(calibration_.cx_px)), per_focal),
                    hn::Mul(hn::Sub(v, all(calibration_.cy_px)), per_focal), z};
    const Vectors turned = rotated(state_.motion, p), start = plus(turned, all(state_.motion.translation));
    const Vectors by_disparity = times(hn::Div(all(-1), disparity), turned);
    // The shutter: each point moves on until its row of the current frame is exposed.
    Vectors q = start, by_shutter = shift_;
    const int passes = state_.shutter != 0 ? 3 : 1;  // the row depends on the time, little
    const Double rows = all(current_.disparity.height() - 1);
    for (int i = 0; i < passes; ++i) {
      valid = hn::And(valid, hn::Gt(q.z, all(min_depth_m)));
      const Double row = hn::Add(hn::Div(hn::Mul(focal_, q.y), q.z), all(calibration_.cy_px));
      const Vectors speed = plus(shift_, cross(turn_, q));
      by_shutter = times(hn::Div(hn::Sub(row, v), rows), speed);
      q = plus(start, times(all(state_.shutter), by_shutter));
    }
    const Double pixels_per_m = hn::Div(focal_, q.z);
    return {q,
            hn::MulAdd(pixels_per_m, q.x, all(calibration_.cx_px)),
            hn::MulAdd(pixels_per_m, q.y, all(calibration_.cy_px)),
            pixels_per_m,
            z,
            disparity,
            shape,
            by_disparity,
            by_shutter,
            hn::And(valid, hn::Gt(q.z, all(min_depth_m)))};
  }

  HWY_INLINE void compare_grey_levels(const MovedPoints& moved, BlockLanes equation) const {
    const Vectors& q = moved.q;
    const Double scale = hn::Mul(all(scale_), moved.pixels_per_m), grey = batch_.grey.load();
    const Double gu = hn::Mul(batch_.per_column.load(), scale), gv = hn::Mul(batch_.per_row.load(), scale);
    const Vectors by_q{gu, gv, hn::Div(hn::Neg(hn::MulAdd(gu, q.x, hn::Mul(gv, q.y))), q.z)};
    equation.put_residual(
        hn::Sub(hn::Sub(batch_.sample.load(), hn::Mul(all(state_.gain), grey)), all(state_.brightness)));
    equation.put_motion(by_q, q);
    equation.put(shutter_index, dot(by_q, moved.by_shutter));
    equation.put(gain_index, hn::Neg(grey));
    equation.put(brightness_index, all(-1));
    const Double by_offset = dot(by_q, moved.by_disparity);
    equation.put(offset_index, hn::Mul(by_offset, moved.shape));
    equation.put(growth_index, hn::Mul(by_offset, hn::Sub(moved.shape, all(1))));
    const Double error = hn::Mul(by_offset, batch_.sigma.load());
    equation.put_variance(hn::Mul(error, error));
  }

  /// The measured disparity where a point is seen against that of the point, point to plane.
  HWY_INLINE void compare_disparities(const MovedPoints& moved, hn::Mask<Doubles> seen, std::size_t lane,
                                      EquationBlock& block) const {
    const Vectors& q = moved.q;
    const Surface surface = sample_surface(current_.disparity, current_.sigma, moved.u, moved.v);
    // N·p = b for points of the plane around the point of the reference.
    const Double slope_u = batch_.slope_u.load(), slope_v = batch_.slope_v.load();
    const Double along = hn::MulAdd(slope_u, hn::Sub(batch_.u.load(), all(calibration_.cx_px)),
                                    hn::Mul(slope_v, hn::Sub(batch_.v.load(), all(calibration_.cy_px))));
    const Vectors normal = rotated(state_.motion, {slope_u, slope_v, hn::Div(hn::Sub(moved.disparity, along), focal_)});
    const Double towards = dot(normal, q);
    BlockLanes equation(block, lane, hn::And(hn::And(seen, surface.valid), hn::Gt(towards, all(0))));
    const Double here = shape_of_offset(moved.u, surface.disparity), predicted = hn::Div(depth_scale_, q.z);
    const Vectors by_q = times(hn::Div(predicted, towards), normal);
    equation.put_residual(hn::Sub(hn::Add(surface.disparity, offset(here)), predicted));
    equation.put_motion(by_q, q);
    equation.put(shutter_index, dot(by_q, moved.by_shutter));
    equation.put(gain_index, all(0));
    equation.put(brightness_index, all(0));
    const Double by_offset = dot(by_q, moved.by_disparity);
    equation.put(offset_index, hn::MulAdd(by_offset, moved.shape, here));
    equation.put(growth_index, hn::MulAdd(by_offset, hn::Sub(moved.shape, all(1)), hn::Sub(here, all(1))));
    const Double error = hn::Mul(by_offset, batch_.sigma.load());
    equation.put_variance(hn::MulAdd(surface.sigma, surface.sigma, hn::Mul(error, error)));
  }

  const LinkMaps& current_;
  const StereoCalibration& calibration_;
  const AlignmentState& state_;
  ImageView<const std::int16_t> grey_;
  double scale_;
  Double focal_, depth_scale_;
  Vectors turn_, shift_;
  Batch batch_;
};

/// The blocks first … last − 1. Returns the area of the points that is seen; a point that is as near as it was
/// counts 1.
double linearise_blocks(const std::vector<ReferencePoint>& points, const LinkMaps& current,
                        const StereoCalibration& calibration, int level, const AlignmentState& state, int first,
                        int last, AlignmentEquations& equations) {
  Linearisation linearisation(current, calibration, level, state);
  EquationBlock::Lanes visible{};
  for (auto block = static_cast<std::size_t>(first); block < static_cast<std::size_t>(last); ++block) {
    for (std::size_t lane = 0; lane < EquationBlock::lanes; lane += hn::Lanes(Doubles())) {
      linearisation.add(points, block * EquationBlock::lanes + lane, equations.grey[block], equations.disparity[block],
                        visible);
    }
  }
  return std::accumulate(visible.begin(), visible.end(), 0.0);
}

/// Sums of a lane of the blocks, added up last: they do not depend on the length of a vector.
using LaneSums = std::array<std::array<EquationBlock::Lanes, unknowns + 1>, unknowns + 1>;

void add_lanes(const EquationBlock& block, LaneSums& sums) {
  const Doubles d;
  const auto row = [&block](std::size_t i) { return i < unknowns ? block.row[i].data() : block.residual.data(); };
  for (std::size_t lane = 0; lane < EquationBlock::lanes; lane += hn::Lanes(d)) {
    const Double weight = hn::Load(d, block.weight.data() + lane);
    for (std::size_t i = 0; i <= unknowns; ++i) {
      const Double weighted = hn::Mul(weight, hn::Load(d, row(i) + lane));
      for (std::size_t j = 0; j <= i; ++j) {
        double* const sum = sums[i][j].data() + lane;
        hn::Store(hn::MulAdd(weighted, hn::Load(d, row(j) + lane), hn::Load(d, sum)), d, sum);
      }
    }
  }
}

void add_products_of_blocks(const EquationBlocks& equations, Matrix<unknowns + 1>& sums) {
  alignas(64) LaneSums lanes{};
  for (const EquationBlock& block : equations) add_lanes(block, lanes);
  for (std::size_t i = 0; i <= unknowns; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      for (const double sum : lanes[i][j]) sums[i][j] += sum;
    }
  }
}

}  // namespace roadstereo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace roadstereo {

HWY_EXPORT(linearise_blocks);
HWY_EXPORT(add_products_of_blocks);

void linearise(const std::vector<ReferencePoint>& points, const LinkMaps& current, const StereoCalibration& calibration,
               int level, const AlignmentState& state, int threads, AlignmentEquations& equations) {
  constexpr int blocks_per_band = 40;
  const int blocks = static_cast<int>(block_count(points.size()));
  equations.grey.resize(static_cast<std::size_t>(blocks));
  equations.disparity.resize(static_cast<std::size_t>(blocks));
  auto visible = scratch_vector<double>(static_cast<std::size_t>(blocks / blocks_per_band) + 1);
  parallel_rows(blocks, blocks_per_band, threads, [&](int first, int last, int) {
    visible[static_cast<std::size_t>(first / blocks_per_band)] =
        HWY_DYNAMIC_DISPATCH(linearise_blocks)(points, current, calibration, level, state, first, last, equations);
  });
  equations.visible = std::accumulate(visible.begin(), visible.end(), 0.0);
  equations.seen = 0;
  for (const EquationBlock& block : equations.grey) {
    for (const bool valid : block.valid) equations.seen += valid ? 1 : 0;
  }
}

void add_products(const EquationBlocks& equations, Matrix<unknowns + 1>& sums) {
  HWY_DYNAMIC_DISPATCH(add_products_of_blocks)(equations, sums);
}

}  // namespace roadstereo
#endif
