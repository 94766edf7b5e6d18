#include "odometry/direct_alignment.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/order_statistics.hpp"
#include "core/parallel.hpp"
#include "odometry/alignment_equations.hpp"
#include "odometry/alignment_weights.hpp"
#include "odometry/anderson_acceleration.hpp"
#include "odometry/normal_equations.hpp"
#include "odometry/patch_matching.hpp"

namespace roadstereo {
namespace {

constexpr std::size_t min_points = 50;
constexpr double unknown_offset_sd_px = 0.5;  // of the offset of a rig of which nothing is known
// Of what nothing is known, when the rig is examined: offsets in pixels, the shutter by the time between both frames.
constexpr double any_offset_sd_px = 10, any_shutter_sd = 10;

/// Standard deviations of what is known of these unknowns; 0: all.
struct Spread {
  double offset_px = 0;
  double growth_px = 0;
  double shutter = 0;
};

class Aligner {
 public:
  Aligner(const ReferencePoints& reference, const LinkMaps& current, const StereoCalibration& calibration,
          const RigidMotion& start, const OffsetPrior& prior, int threads)
      : reference_(reference),
        current_(current),
        calibration_(calibration),
        prior_(prior),
        threads_(threads),
        grey_memory_(memory_for(reference)),
        disparity_memory_(memory_for(reference)) {
    state_.motion = start;
    state_.offset_px = prior.mean_px;
    equations_.reserve(most_blocks(reference));
    auto disparities = scratch_vector<double>();
    disparities.reserve(reference.levels.back().size());
    for (const ReferencePoint& point : reference.levels.back()) disparities.push_back(point.disparity);
    const double typical_disparity =
        disparities.empty() ? 1 : upper_median(disparities) + calibration.disparity_offset_px;
    typical_depth_m_ = calibration.focal_px * calibration.baseline_m / typical_disparity;
  }

  /// Until a step moves the points by less than `converged_px` of the level.
  void run_level(int level, double converged_px) {
    constexpr int max_iterations = 12;
    const std::vector<ReferencePoint>& points = reference_.levels[static_cast<std::size_t>(level)];
    AndersonAcceleration<unknowns> acceleration;
    for (int i = 0; i < max_iterations; ++i) {
      linearise(points, current_, calibration_, level, state_, threads_, equations_);
      if (equations_.seen < min_points) return;
      weigh();
      if (shift_px(step({prior_.sd_px, 0, 0}, acceleration), level) < converged_px) break;
    }
  }

  Alignment result(int level) {
    Alignment alignment;
    const std::vector<ReferencePoint>& points = reference_.levels[static_cast<std::size_t>(level)];
    linearise(points, current_, calibration_, level, state_, threads_, equations_);
    alignment.motion = state_.motion;
    if (equations_.seen < min_points) return alignment;
    alignment.overlap = equations_.visible / static_cast<double>(points.size());
    weigh();
    scatter_ = scatter_of_scores();
    fill_covariance(alignment);
    examine_rig(points, level, alignment);
    alignment.correlation = patch_correlation(reference_, current_, calibration_, state_.motion, state_.offset_px);
    return alignment;
  }

 private:
  static std::size_t most_blocks(const ReferencePoints& reference) {
    std::size_t points = 0;
    for (const std::vector<ReferencePoint>& level : reference.levels) points = std::max(points, level.size());
    return block_count(points);
  }
  static WeightMemory memory_for(const ReferencePoints& reference) {
    return {most_blocks(reference), static_cast<std::size_t>(reference.cells)};
  }

  void weigh() {
    std::array<Matrix<unknowns + 1>, 2> products{};
    parallel_for(2, threads_, [&](int kind, int) {
      if (kind == 0) {
        weigh_grey_levels(equations_.grey, noise_, grey_memory_);
        add_products(equations_.grey, products[0]);
      } else {
        weigh_disparities(equations_.disparity, disparity_memory_);
        add_products(equations_.disparity, products[1]);
      }
    });
    normal_ = {};
    for (const Matrix<unknowns + 1>& of_kind : products) normal_.add(of_kind);
  }

  NormalEquations normal_equations(const Spread& spread) const {
    NormalEquations normal = normal_;
    normal.expect(offset_index, state_.offset_px - prior_.mean_px, spread.offset_px);
    normal.expect(growth_index, state_.growth_px, spread.growth_px);
    normal.expect(shutter_index, state_.shutter, spread.shutter);
    return normal;
  }

  /// One step of Gauss–Newton, longer or shorter as the last ones say; returns the step itself.
  Vector<unknowns> step(const Spread& spread, AndersonAcceleration<unknowns>& acceleration) {
    const NormalEquations normal = normal_equations(spread);
    const Vector<unknowns> x = normal.solved();
    take(acceleration.accelerated(x, normal.matrix));
    return x;
  }

  /// By how much a step moves the points, pixels of the level.
  double shift_px(const Vector<unknowns>& x, int level) const {
    const double f = calibration_.focal_px;
    return (f * std::hypot(x[0], x[1], x[2]) / typical_depth_m_ + f * std::hypot(x[3], x[4], x[5])) / (1 << level);
  }

  void take(const Vector<unknowns>& x) {
    state_.motion = rigid_motion({x[0], x[1], x[2], x[3], x[4], x[5]}) * state_.motion;
    state_.gain += x[gain_index];
    state_.brightness += x[brightness_index];
    state_.offset_px += x[offset_index];
    state_.growth_px += x[growth_index];
    state_.shutter += x[shutter_index];
  }

  void fill_covariance(Alignment& alignment) {
    const Matrix<unknowns> covariance = sandwich({prior_.sd_px, 0, 0});
    for (std::size_t i = 0; i < 6; ++i) std::copy_n(covariance[i].begin(), 6, alignment.covariance[i].begin());
    alignment.offset_px = state_.offset_px;
    alignment.offset_sd_px = std::sqrt(covariance[offset_index][offset_index]);
    // What one more step with a free offset finds.
    const Spread free_offset{unknown_offset_sd_px, 0, 0};
    alignment.measured_offset_px = state_.offset_px + normal_equations(free_offset).solved()[offset_index];
    alignment.measured_offset_sd_px = std::sqrt(sandwich(free_offset)[offset_index][offset_index]);
  }

  /// What further steps with a free shutter and a free offset of the disparities find, until one is less than a tenth
  /// of a standard error. The first alone overshoots by a tenth or more: the gradients of fine texture are too small.
  void examine_rig(const std::vector<ReferencePoint>& points, int level, Alignment& alignment) {
    constexpr int steps = 6;
    constexpr double noteworthy_std_errors = 2, small_std_errors = 0.1;
    const Spread free{any_offset_sd_px, any_offset_sd_px, any_shutter_sd};
    const AlignmentState before = state_;
    AndersonAcceleration<unknowns> acceleration;
    for (int i = 0; i < steps; ++i) {
      if (i > 0) {
        linearise(points, current_, calibration_, level, state_, threads_, equations_);
        if (equations_.seen < min_points) break;
        weigh();
        scatter_ = scatter_of_scores();
      }
      const Matrix<unknowns> covariance = sandwich(free);
      const Vector<unknowns> x = step(free, acceleration);
      alignment.rig_offset_sd_px = std::sqrt(covariance[offset_index][offset_index]);
      alignment.shutter_sd = std::sqrt(covariance[shutter_index][shutter_index]);
      const auto both_below = [&alignment](double offset_px, double shutter, double std_errors) {
        return std::abs(offset_px) < std_errors * alignment.rig_offset_sd_px &&
               std::abs(shutter) < std_errors * alignment.shutter_sd;
      };
      if (both_below(state_.offset_px, state_.shutter, noteworthy_std_errors)) break;
      if (both_below(x[offset_index], x[shutter_index], small_std_errors)) break;
    }
    alignment.rig_offset_px = state_.offset_px;
    alignment.shutter = state_.shutter;
    state_ = before;
  }

  /// Scores of the cells: sums of the weighted residuals times their derivatives.
  struct Scatter {
    Matrix<unknowns> matrix{};  ///< Σ g gᵀ
    std::size_t cells = 0;      ///< that have one
  };

  Scatter scatter_of_scores() const {
    auto scores = scratch_vector<Vector<unknowns>>(static_cast<std::size_t>(reference_.cells));
    const auto add_scores = [&scores](const EquationBlocks& equations) {
      for (const EquationBlock& block : equations) {
        for (std::size_t lane = 0; lane < EquationBlock::lanes; ++lane) {
          const double weighted = block.weight[lane] * block.residual[lane];
          Vector<unknowns>& score = scores[static_cast<std::size_t>(block.cell[lane])];
          for (std::size_t i = 0; i < unknowns; ++i) score[i] += weighted * block.row[i][lane];
        }
      }
    };
    add_scores(equations_.grey);
    add_scores(equations_.disparity);
    Scatter scatter;
    for (const Vector<unknowns>& score : scores) {
      if (std::all_of(score.begin(), score.end(), [](double s) { return s == 0; })) continue;
      ++scatter.cells;
      add_outer(score, scatter.matrix);
    }
    return scatter;
  }

  /// H⁻¹ (Σ g gᵀ) H⁻¹ with the scores g of the cells.
  Matrix<unknowns> sandwich(const Spread& spread) const {
    Matrix<unknowns> scatter = scatter_.matrix;
    const auto add_expectation = [&scatter](std::size_t index, double sd) {
      if (sd > 0) {
        scatter[index][index] += 1 / (sd * sd);
        return;
      }
      for (std::size_t i = 0; i < unknowns; ++i) scatter[index][i] = scatter[i][index] = 0;
    };
    add_expectation(offset_index, spread.offset_px);
    add_expectation(growth_index, spread.growth_px);
    add_expectation(shutter_index, spread.shutter);
    Matrix<unknowns> factor = normal_equations(spread).matrix;
    factor_in_place(factor, NormalEquations::smallest);
    factor_in_place(scatter, NormalEquations::smallest);
    Matrix<unknowns> covariance{};
    for (std::size_t j = 0; j < unknowns; ++j) {
      Vector<unknowns> column{};
      for (std::size_t i = j; i < unknowns; ++i) column[i] = scatter[i][j];
      add_outer(solve_factored(factor, column), covariance);
    }
    const std::size_t used = scatter_.cells;
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
  const LinkMaps& current_;
  const StereoCalibration& calibration_;
  OffsetPrior prior_;
  int threads_;
  double typical_depth_m_ = 0;
  double noise_ = 10;  ///< of the grey levels; a start
  AlignmentState state_;
  AlignmentEquations equations_;
  NormalEquations normal_;  ///< of the weighted equations
  Scatter scatter_;         ///< of the same
  WeightMemory grey_memory_, disparity_memory_;
};

}  // namespace

Alignment align(const ReferencePoints& reference, const LinkMaps& current, const StereoCalibration& calibration,
                const RigidMotion& start, const OffsetPrior& offset, int coarsest, int finest, int threads) {
  Aligner aligner(reference, current, calibration, start, offset, threads);
  const int levels = std::min(current.pyramid.levels(), static_cast<int>(reference.levels.size()));
  constexpr double start_of_finer_px = 0.1, converged_px = 0.01;
  for (int level = std::min(coarsest, levels - 1); level >= finest; --level) {
    aligner.run_level(level, level > finest ? start_of_finer_px : converged_px);
  }
  return aligner.result(std::min(finest, levels - 1));
}

}  // namespace roadstereo
