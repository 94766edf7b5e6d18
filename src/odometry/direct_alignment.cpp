#include "odometry/direct_alignment.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/order_statistics.hpp"
#include "odometry/alignment_equations.hpp"
#include "odometry/alignment_weights.hpp"
#include "odometry/patch_matching.hpp"

namespace roadstereo {
namespace {

constexpr std::size_t min_points = 50;
constexpr double smallest = 1e-12;            // of a diagonal element: rounding
constexpr double unknown_offset_sd_px = 0.5;  // of the offset of a rig of which nothing is known
// Of what nothing is known, when the rig is examined: offsets in pixels, the shutter by the time between both frames.
constexpr double any_offset_sd_px = 10, any_shutter_sd = 10;

/// Standard deviations of what is known of these unknowns; 0: all.
struct Spread {
  double offset_px = 0;
  double growth_px = 0;
  double shutter = 0;
};

struct NormalEquations {
  Matrix<unknowns> matrix{};
  Vector<unknowns> right{};

  void add(const std::vector<AlignmentEquation>& equations) {
    for (const AlignmentEquation& e : equations) {
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
    const std::vector<ReferencePoint>& points = reference_.levels[static_cast<std::size_t>(level)];
    double noise = 10;  // grey levels; a start
    for (int i = 0; i < max_iterations; ++i) {
      linearise(points, current_, calibration_, level, state_, equations_);
      if (equations_.grey.size() < min_points) return;
      weigh(noise);
      if (step(level) < converged_px) break;
    }
  }

  Alignment result(int level) {
    Alignment alignment;
    const std::vector<ReferencePoint>& points = reference_.levels[static_cast<std::size_t>(level)];
    linearise(points, current_, calibration_, level, state_, equations_);
    alignment.motion = state_.motion;
    if (points.empty() || equations_.grey.size() < min_points) return alignment;
    alignment.overlap = equations_.visible / static_cast<double>(points.size());
    double noise = 10;
    weigh(noise);
    fill_covariance(alignment);
    examine_rig(points, level, noise, alignment);
    alignment.correlation = patch_correlation(reference_, current_, calibration_, state_.motion, state_.offset_px);
    return alignment;
  }

 private:
  void weigh(double& noise) {
    weigh_grey_levels(equations_.grey, noise, sums_, scratch_);
    if (!equations_.disparity.empty()) weigh_disparities(equations_.disparity, sums_, scratch_);
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
  void examine_rig(const std::vector<ReferencePoint>& points, int level, double noise, Alignment& alignment) {
    constexpr int steps = 6;
    constexpr double noteworthy_std_errors = 2;
    const Spread free{any_offset_sd_px, any_offset_sd_px, any_shutter_sd};
    const AlignmentState before = state_;
    for (int i = 0; i < steps; ++i) {
      if (i > 0) {
        linearise(points, current_, calibration_, level, state_, equations_);
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
    const auto add_scores = [&scores](const std::vector<AlignmentEquation>& equations) {
      for (const AlignmentEquation& e : equations) {
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
  AlignmentState state_;
  AlignmentEquations equations_;
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
