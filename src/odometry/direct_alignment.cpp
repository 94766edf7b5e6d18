#include "odometry/direct_alignment.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/order_statistics.hpp"
#include "odometry/patch_matching.hpp"

namespace roadstereo {
namespace {

/// Six of the motion, gain and offset of the grey levels, offset of the disparities, by how much that offset grows
/// towards the sides more than its shape says, shutter.
constexpr std::size_t unknowns = 11;
constexpr std::size_t gain_index = 6, brightness_index = 7, offset_index = 8, growth_index = 9, shutter_index = 10;
constexpr double min_depth_m = 0.05;
constexpr std::size_t min_points = 50;
constexpr double smallest = 1e-12;            // of a diagonal element: rounding
constexpr double unknown_offset_sd_px = 0.5;  // of the offset of a rig of which nothing is known
// Of what nothing is known, when the rig is examined: offsets in pixels, the shutter by the time between both frames.
constexpr double any_offset_sd_px = 10, any_shutter_sd = 10;

/// One equation: residual + row·x = 0.
struct Equation {
  std::array<double, unknowns> row{};
  double residual = 0;
  double variance = 0;  ///< known part
  double total_variance = 0;
  double weight = 0;
  int cell = 0;
};

/// Equations of a level at the present motion.
struct Equations {
  std::vector<Equation> grey;
  std::vector<Equation> disparity;
  double visible = 0;  ///< points, each by the area of what it stands for that is left
};

/// Bilinear sample; false outside.
bool sample_grey(const Image<GreySample>& level, double x, double y, GreySample& sample) {
  constexpr int margin = 1;
  if (!(x >= margin && y >= margin && x < level.width() - 1 - margin && y < level.height() - 1 - margin)) return false;
  const int u = static_cast<int>(x), v = static_cast<int>(y);
  const float fu = static_cast<float>(x - u), fv = static_cast<float>(y - v);
  const GreySample* a = level.row(v) + u;
  const GreySample* b = level.row(v + 1) + u;
  const float w00 = (1 - fu) * (1 - fv), w10 = fu * (1 - fv), w01 = (1 - fu) * fv, w11 = fu * fv;
  sample.grey = w00 * a[0].grey + w10 * a[1].grey + w01 * b[0].grey + w11 * b[1].grey;
  sample.per_column = w00 * a[0].per_column + w10 * a[1].per_column + w01 * b[0].per_column + w11 * b[1].per_column;
  sample.per_row = w00 * a[0].per_row + w10 * a[1].per_row + w01 * b[0].per_row + w11 * b[1].per_row;
  return true;
}

/// Present estimate.
struct State {
  RigidMotion motion;
  double gain = 1;
  double brightness = 0;
  double offset_px = 0;
  double growth_px = 0;
  double shutter = 0;

  /// Offset of the disparity where the shape of an offset has a value.
  double offset(double shape) const { return offset_px * shape + growth_px * (shape - 1); }
};

/// Velocity of points at the end of a motion that was a constant one, per duration of the motion.
class EndVelocity {
 public:
  explicit EndVelocity(const RigidMotion& motion) {
    const Twist twist = twist_of(motion);
    turn_ = {twist[3], twist[4], twist[5]};
    const Vector<3>&t = motion.translation, bend = cross(turn_, t);
    for (std::size_t i = 0; i < 3; ++i) shift_[i] = t[i] - bend[i] / 2;
  }

  Vector<3> operator()(const Vector<3>& q) const {
    const Vector<3> turned = cross(turn_, q);
    return {shift_[0] + turned[0], shift_[1] + turned[1], shift_[2] + turned[2]};
  }

 private:
  Vector<3> turn_{}, shift_{};
};

/// Point of the reference at the present motion.
struct MovedPoint {
  Vector<3> q{};        ///< in the current camera frame, metres
  double u = 0, v = 0;  ///< its pixel
  double disparity = 0, shape = 0;
  Vector<3> by_disparity{}, by_shutter{};  ///< derivatives of q
};

class Linearisation {
 public:
  Linearisation(const FrameMaps& current, const StereoCalibration& calibration, int level)
      : current_(current),
        calibration_(calibration),
        samples_(current.pyramid.level(level)),
        scale_(1.0 / (1 << level)),
        depth_scale_(calibration.focal_px * calibration.baseline_m),
        rows_(current.disparity.height() - 1) {}

  void build(const std::vector<ReferencePoint>& points, const State& state, Equations& equations) const {
    equations.grey.clear();
    equations.disparity.clear();
    equations.visible = 0;
    const EndVelocity velocity(state.motion);
    for (const ReferencePoint& point : points) add(point, state, velocity, equations);
  }

 private:
  void add(const ReferencePoint& point, const State& state, const EndVelocity& velocity, Equations& equations) const {
    const double shape = offset_shape(calibration_, point.u, point.disparity);
    const double disparity = point.disparity + state.offset(shape) + calibration_.disparity_offset_px;
    if (!(disparity > 0)) return;
    const double f = calibration_.focal_px;
    const double z = depth_scale_ / disparity;
    const Vector<3> p{(point.u - calibration_.cx_px) / f * z, (point.v - calibration_.cy_px) / f * z, z};
    Vector<3> q = state.motion(p);
    Vector<3> by_shutter{};
    if (!end_of_motion(state.shutter, point.v, velocity, q, by_shutter)) return;
    const double u = f * q[0] / q[2] + calibration_.cx_px, v = f * q[1] / q[2] + calibration_.cy_px;
    GreySample sample;
    if (!sample_grey(samples_, (u + 0.5) * scale_ - 0.5, (v + 0.5) * scale_ - 0.5, sample)) return;
    const double scale = z / q[2];
    equations.visible += std::min(1.0, scale * scale);
    // Derivative of q by the disparity.
    const Vector<3> turned = state.motion.rotated(p);
    const Vector<3> by_disparity{-turned[0] / disparity, -turned[1] / disparity, -turned[2] / disparity};
    // Derivative of the grey level by q.
    const double gu = sample.per_column * scale_ * f / q[2], gv = sample.per_row * scale_ * f / q[2];
    const Vector<3> by_q{gu, gv, -(gu * q[0] + gv * q[1]) / q[2]};
    Equation equation;
    equation.cell = point.cell;
    equation.residual = sample.grey - state.gain * point.grey - state.brightness;
    put_motion(by_q, q, equation);
    equation.row[shutter_index] = dot(by_q, by_shutter);
    equation.row[gain_index] = -point.grey;
    equation.row[brightness_index] = -1;
    const double by_offset = dot(by_q, by_disparity);
    equation.row[offset_index] = by_offset * shape;
    equation.row[growth_index] = by_offset * (shape - 1);
    equation.variance = by_offset * by_offset * point.sigma_px * point.sigma_px;
    equations.grey.push_back(equation);
    add_disparity(point, state, {q, u, v, disparity, shape, by_disparity, by_shutter}, equations);
  }

  /// Moves a point on to when its row of the current frame is exposed, by the shutter; `by_shutter`: derivative. False
  /// behind the camera.
  bool end_of_motion(double shutter, double reference_row, const EndVelocity& velocity, Vector<3>& q,
                     Vector<3>& by_shutter) const {
    const Vector<3> start = q;
    const int passes = shutter != 0 ? 3 : 1;  // the row depends on the time, little
    for (int i = 0; i < passes; ++i) {
      if (!(q[2] > min_depth_m)) return false;
      const Vector<3> speed = velocity(q);
      const double row = calibration_.focal_px * q[1] / q[2] + calibration_.cy_px;
      const double later = (row - reference_row) / rows_;
      for (std::size_t k = 0; k < 3; ++k) {
        by_shutter[k] = later * speed[k];
        q[k] = start[k] + shutter * by_shutter[k];
      }
    }
    return q[2] > min_depth_m;
  }

  /// The measured disparity where a point is seen against that of the point, point to plane.
  void add_disparity(const ReferencePoint& point, const State& state, const MovedPoint& moved,
                     Equations& equations) const {
    SurfaceSample surface;
    if (!sample_surface(current_, moved.u, moved.v, surface)) return;
    const double f = calibration_.focal_px;
    const Vector<3>& q = moved.q;
    // N·p = b for points of the plane around the point of the reference.
    const Vector<3> plane{point.slope_u, point.slope_v,
                          (moved.disparity - point.slope_u * (point.u - calibration_.cx_px) -
                           point.slope_v * (point.v - calibration_.cy_px)) /
                              f};
    const Vector<3> normal = state.motion.rotated(plane);
    const double towards = dot(normal, q);
    if (!(towards > 0)) return;
    const double here = offset_shape(calibration_, moved.u, surface.disparity);
    const double factor = depth_scale_ / (q[2] * towards);
    const Vector<3> by_q{factor * normal[0], factor * normal[1], factor * normal[2]};
    Equation equation;
    equation.cell = point.cell;
    equation.residual = surface.disparity + state.offset(here) + calibration_.disparity_offset_px - depth_scale_ / q[2];
    put_motion(by_q, q, equation);
    equation.row[shutter_index] = dot(by_q, moved.by_shutter);
    const double by_offset = dot(by_q, moved.by_disparity);
    equation.row[offset_index] = here + by_offset * moved.shape;
    equation.row[growth_index] = here - 1 + by_offset * (moved.shape - 1);
    equation.variance = surface.sigma_px * surface.sigma_px + by_offset * by_offset * point.sigma_px * point.sigma_px;
    equations.disparity.push_back(equation);
  }

  /// Derivatives by a translation and a rotation of q.
  static void put_motion(const Vector<3>& by_q, const Vector<3>& q, Equation& equation) {
    const Vector<3> by_rotation = cross(q, by_q);
    for (std::size_t i = 0; i < 3; ++i) {
      equation.row[i] = by_q[i];
      equation.row[i + 3] = by_rotation[i];
    }
  }

  const FrameMaps& current_;
  const StereoCalibration& calibration_;
  const Image<GreySample>& samples_;
  double scale_;
  double depth_scale_;
  double rows_;  ///< from the first to the last
};

/// Tukey's biweight of a standardised residual.
double tukey(double z) {
  constexpr double truncation = 4.685;  // 95 % efficiency on normal residuals
  const double relative = z / truncation;
  return std::abs(relative) < 1 ? (1 - relative * relative) * (1 - relative * relative) : 0;
}

/// Weights grey levels: their variance is that of the noise, estimated from the residuals, and that of the depths.
void weigh_grey(std::vector<Equation>& equations, double& noise, std::vector<double>& scratch) {
  constexpr double min_noise = 0.3;  // grey levels: that of rounding to 8 bits
  for (int pass = 0; pass < 2; ++pass) {
    scratch.clear();
    for (const Equation& e : equations) scratch.push_back(e.residual * noise / std::sqrt(noise * noise + e.variance));
    noise = std::max(gaussian_mad * upper_median_magnitude(scratch), min_noise);
  }
  for (Equation& e : equations) {
    e.total_variance = noise * noise + e.variance;
    e.weight = tukey(e.residual / std::sqrt(e.total_variance)) / e.total_variance;
  }
}

/// Lowers the weights of cells whose residuals are larger than those of most cells: something moves there, or is seen
/// by one frame only. A single residual cannot tell, since a wrong grey level may fit by chance.
void weigh_cells(std::vector<Equation>& equations, std::vector<double>& squares, std::vector<double>& scratch) {
  constexpr double usual_spread = 1.5;  // of the mean squares of cells that fit
  std::vector<double> counts(squares.size(), 0);
  std::fill(squares.begin(), squares.end(), 0.0);
  for (const Equation& e : equations) {
    squares[static_cast<std::size_t>(e.cell)] += e.residual * e.residual / e.total_variance;
    counts[static_cast<std::size_t>(e.cell)] += 1;
  }
  scratch.clear();
  for (std::size_t i = 0; i < squares.size(); ++i) {
    if (counts[i] > 0) scratch.push_back(squares[i] /= counts[i]);
  }
  const double limit = usual_spread * std::max(upper_median(scratch), 1.0);  // 1: as their variances say
  for (Equation& e : equations) {
    const double ratio = limit / std::max(squares[static_cast<std::size_t>(e.cell)], limit);
    e.weight *= ratio * ratio;
  }
}

/// Weights disparities: their variances are known up to a factor.
void weigh_disparities(std::vector<Equation>& equations, std::vector<double>& scratch) {
  scratch.clear();
  for (const Equation& e : equations) scratch.push_back(e.residual / std::sqrt(e.variance));
  constexpr double min_factor = 0.5;
  const double factor = std::max(gaussian_mad * upper_median_magnitude(scratch), min_factor);
  for (Equation& e : equations) {
    e.total_variance = factor * factor * e.variance;
    e.weight = tukey(e.residual / std::sqrt(e.total_variance)) / e.total_variance;
  }
}

/// How many times the variance of sums of a cell exceeds that of independent residuals.
double correlation_factor(const std::vector<Equation>& equations, std::vector<double>& sums) {
  std::fill(sums.begin(), sums.end(), 0.0);
  double squares = 0;
  for (const Equation& e : equations) {
    const double z = std::sqrt(e.weight) * e.residual;
    sums[static_cast<std::size_t>(e.cell)] += z;
    squares += z * z;
  }
  double of_sums = 0;
  for (const double sum : sums) of_sums += sum * sum;
  return squares > 0 ? std::max(of_sums / squares, 1.0) : 1;
}

void divide_weights(std::vector<Equation>& equations, double factor) {
  for (Equation& e : equations) e.weight /= factor;
}

/// Standard deviations of what is known of these unknowns; 0: all.
struct Spread {
  double offset_px = 0;
  double growth_px = 0;
  double shutter = 0;
};

struct NormalEquations {
  Matrix<unknowns> matrix{};
  Vector<unknowns> right{};

  void add(const std::vector<Equation>& equations) {
    for (const Equation& e : equations) {
      if (e.weight <= 0) continue;
      for (std::size_t i = 0; i < unknowns; ++i) {
        const double weighted = e.weight * e.row[i];
        right[i] -= weighted * e.residual;
        for (std::size_t j = 0; j <= i; ++j) matrix[i][j] += weighted * e.row[j];
      }
    }
  }

  /// An unknown is expected to be `excess` smaller, with a standard deviation; 0: it stays as it is.
  void expect(std::size_t index, double excess, double sd) {
    if (sd > 0) {
      matrix[index][index] += 1 / (sd * sd);
      right[index] -= excess / (sd * sd);
      return;
    }
    for (std::size_t j = 0; j < index; ++j) matrix[index][j] = 0;
    for (std::size_t i = index + 1; i < unknowns; ++i) matrix[i][index] = 0;
    matrix[index][index] = 1;
    right[index] = 0;
  }
};

class Aligner {
 public:
  Aligner(const ReferencePoints& reference, const FrameMaps& current, const StereoCalibration& calibration,
          const RigidMotion& start, const OffsetPrior& prior)
      : reference_(reference), current_(current), calibration_(calibration), prior_(prior) {
    state_.motion = start;
    state_.offset_px = prior.mean_px;
    sums_.resize(static_cast<std::size_t>(reference.cells));
  }

  void run_level(int level) {
    constexpr int max_iterations = 12;
    constexpr double converged_px = 0.01;  // of the level
    const Linearisation linearisation(current_, calibration_, level);
    const std::vector<ReferencePoint>& points = reference_.levels[static_cast<std::size_t>(level)];
    double noise = 10;  // grey levels; a start
    for (int i = 0; i < max_iterations; ++i) {
      linearisation.build(points, state_, equations_);
      if (equations_.grey.size() < min_points) return;
      weigh(noise);
      if (step(level) < converged_px) break;
    }
  }

  Alignment result(int level) {
    Alignment alignment;
    const Linearisation linearisation(current_, calibration_, level);
    const std::vector<ReferencePoint>& points = reference_.levels[static_cast<std::size_t>(level)];
    linearisation.build(points, state_, equations_);
    alignment.motion = state_.motion;
    if (points.empty() || equations_.grey.size() < min_points) return alignment;
    alignment.overlap = equations_.visible / static_cast<double>(points.size());
    double noise = 10;
    weigh(noise);
    fill_covariance(alignment);
    examine_rig(points, linearisation, noise, alignment);
    alignment.correlation = patch_correlation(reference_, current_, calibration_, state_.motion, state_.offset_px);
    return alignment;
  }

 private:
  void weigh(double& noise) {
    weigh_grey(equations_.grey, noise, scratch_);
    weigh_cells(equations_.grey, sums_, scratch_);
    divide_weights(equations_.grey, correlation_factor(equations_.grey, sums_));
    if (equations_.disparity.empty()) return;
    weigh_disparities(equations_.disparity, scratch_);
    weigh_cells(equations_.disparity, sums_, scratch_);
    divide_weights(equations_.disparity, correlation_factor(equations_.disparity, sums_));
  }

  NormalEquations normal_equations(const Spread& spread) const {
    NormalEquations normal;
    normal.add(equations_.grey);
    normal.add(equations_.disparity);
    normal.expect(offset_index, state_.offset_px - prior_.mean_px, spread.offset_px);
    normal.expect(growth_index, state_.growth_px, spread.growth_px);
    normal.expect(shutter_index, state_.shutter, spread.shutter);
    return normal;
  }

  /// One step of Gauss–Newton; returns by how much it moves the points, pixels of the level.
  double step(int level) {
    const Vector<unknowns> x = solved({prior_.sd_px, 0, 0});
    take(x);
    const double f = calibration_.focal_px;
    const double near_m = calibration_.focal_px * calibration_.baseline_m / typical_disparity();
    const double shift = f * std::hypot(x[0], x[1], x[2]) / near_m + f * std::hypot(x[3], x[4], x[5]);
    return shift / (1 << level);
  }

  void take(const Vector<unknowns>& x) {
    state_.motion = rigid_motion({x[0], x[1], x[2], x[3], x[4], x[5]}) * state_.motion;
    state_.gain += x[gain_index];
    state_.brightness += x[brightness_index];
    state_.offset_px += x[offset_index];
    state_.growth_px += x[growth_index];
    state_.shutter += x[shutter_index];
  }

  double typical_disparity() {
    scratch_.clear();
    for (const ReferencePoint& point : reference_.levels.back()) scratch_.push_back(point.disparity);
    return scratch_.empty() ? 1 : upper_median(scratch_);
  }

  void fill_covariance(Alignment& alignment) {
    const Matrix<unknowns> covariance = sandwich({prior_.sd_px, 0, 0});
    for (std::size_t i = 0; i < 6; ++i) std::copy_n(covariance[i].begin(), 6, alignment.covariance[i].begin());
    alignment.offset_px = state_.offset_px;
    alignment.offset_sd_px = std::sqrt(covariance[offset_index][offset_index]);
    // What one more step with a free offset finds.
    const Spread free_offset{unknown_offset_sd_px, 0, 0};
    alignment.measured_offset_px = state_.offset_px + solved(free_offset)[offset_index];
    alignment.measured_offset_sd_px = std::sqrt(sandwich(free_offset)[offset_index][offset_index]);
  }

  /// What further steps with a free shutter and a free offset of the disparities find. The first step alone overshoots
  /// by a tenth or more: the gradients of fine texture are too small.
  void examine_rig(const std::vector<ReferencePoint>& points, const Linearisation& linearisation, double noise,
                   Alignment& alignment) {
    constexpr int steps = 6;
    constexpr double noteworthy_std_errors = 2;
    const Spread free{any_offset_sd_px, any_offset_sd_px, any_shutter_sd};
    const State before = state_;
    for (int i = 0; i < steps; ++i) {
      if (i > 0) {
        linearisation.build(points, state_, equations_);
        if (equations_.grey.size() < min_points) break;
        weigh(noise);
      }
      const Matrix<unknowns> covariance = sandwich(free);
      take(solved(free));
      alignment.rig_offset_sd_px = std::sqrt(covariance[offset_index][offset_index]);
      alignment.shutter_sd = std::sqrt(covariance[shutter_index][shutter_index]);
      if (std::abs(state_.shutter) < noteworthy_std_errors * alignment.shutter_sd &&
          std::abs(state_.offset_px) < noteworthy_std_errors * alignment.rig_offset_sd_px)
        break;
    }
    alignment.rig_offset_px = state_.offset_px;
    alignment.shutter = state_.shutter;
    state_ = before;
  }

  Vector<unknowns> solved(const Spread& spread) const {
    NormalEquations normal = normal_equations(spread);
    factor_in_place(normal.matrix, smallest);
    return solve_factored(normal.matrix, normal.right);
  }

  /// H⁻¹ (Σ g gᵀ) H⁻¹ with the scores g of the cells.
  Matrix<unknowns> sandwich(const Spread& spread) const {
    std::vector<Vector<unknowns>> scores(sums_.size());
    const auto add_scores = [&scores](const std::vector<Equation>& equations) {
      for (const Equation& e : equations) {
        Vector<unknowns>& score = scores[static_cast<std::size_t>(e.cell)];
        for (std::size_t i = 0; i < unknowns; ++i) score[i] += e.weight * e.residual * e.row[i];
      }
    };
    add_scores(equations_.grey);
    add_scores(equations_.disparity);
    Matrix<unknowns> factor = normal_equations(spread).matrix;
    factor_in_place(factor, smallest);
    std::size_t used = 0;
    Matrix<unknowns> covariance{};
    for (Vector<unknowns>& score : scores) {
      if (std::all_of(score.begin(), score.end(), [](double s) { return s == 0; })) continue;
      ++used;
      if (spread.offset_px <= 0) score[offset_index] = 0;
      if (spread.growth_px <= 0) score[growth_index] = 0;
      if (spread.shutter <= 0) score[shutter_index] = 0;
      add_outer(solve_factored(factor, score), covariance);
    }
    const auto add_expectation = [&](std::size_t index, double sd) {
      if (sd <= 0) return;
      Vector<unknowns> score{};
      score[index] = 1 / sd;
      add_outer(solve_factored(factor, score), covariance);
    };
    add_expectation(offset_index, spread.offset_px);
    add_expectation(growth_index, spread.growth_px);
    add_expectation(shutter_index, spread.shutter);
    const double count = static_cast<double>(used);
    const std::size_t estimated = spread.shutter > 0 ? unknowns : unknowns - 2;
    const double small_sample = used > 2 * estimated ? count / (count - static_cast<double>(estimated)) : 2;
    for (Vector<unknowns>& row : covariance) {
      for (double& value : row) value *= small_sample;
    }
    return covariance;
  }

  static void add_outer(const Vector<unknowns>& x, Matrix<unknowns>& sum) {
    for (std::size_t i = 0; i < unknowns; ++i) {
      for (std::size_t j = 0; j < unknowns; ++j) sum[i][j] += x[i] * x[j];
    }
  }

  const ReferencePoints& reference_;
  const FrameMaps& current_;
  const StereoCalibration& calibration_;
  OffsetPrior prior_;
  State state_;
  Equations equations_;
  std::vector<double> scratch_;
  std::vector<double> sums_;
};

}  // namespace

Alignment align(const ReferencePoints& reference, const FrameMaps& current, const StereoCalibration& calibration,
                const RigidMotion& start, const OffsetPrior& offset, int coarsest, int finest) {
  Aligner aligner(reference, current, calibration, start, offset);
  const int levels = std::min(current.pyramid.levels(), static_cast<int>(reference.levels.size()));
  for (int level = std::min(coarsest, levels - 1); level >= finest; --level) aligner.run_level(level);
  return aligner.result(std::min(finest, levels - 1));
}

}  // namespace roadstereo
