#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "core/cholesky.hpp"
#include "core/scratch.hpp"
#include "odometry/reference_points.hpp"
#include "odometry/rigid_motion.hpp"
#include "roadstereo/calibration.hpp"

namespace roadstereo {

/// Six of the motion, gain and offset of the grey levels, disparity offset at the principal point, its additional
/// growth towards the sides, shutter time.
inline constexpr std::size_t unknowns = 11;
inline constexpr std::size_t gain_index = 6, brightness_index = 7, offset_index = 8, growth_index = 9,
                             shutter_index = 10;

/// Equations residual + row·x = 0 of neighbouring points of a reference, one in each lane. Where there is none, row and
/// residual are 0 and the variance is 1.
struct alignas(64) EquationBlock {
  static constexpr std::size_t lanes = 8;
  using Lanes = std::array<double, lanes>;

  std::array<Lanes, unknowns> row;
  Lanes residual;
  Lanes variance;  ///< known part
  Lanes total_variance;
  Lanes weight;
  std::array<int, lanes> cell;    ///< of the image
  std::array<bool, lanes> valid;  ///< whether there is an equation
};
using EquationBlocks = ScratchVector<EquationBlock>;

inline std::size_t block_count(std::size_t points) {
  return (points + EquationBlock::lanes - 1) / EquationBlock::lanes;
}

/// Equations of a level at the present motion.
struct AlignmentEquations {
  EquationBlocks grey = scratch_vector<EquationBlock>();
  EquationBlocks disparity = scratch_vector<EquationBlock>();
  std::size_t seen = 0;  ///< points that the frame shows: equations of grey levels
  double visible = 0;    ///< the same, each by the area of what it stands for that is left

  void reserve(std::size_t blocks) {
    grey.reserve(blocks);
    disparity.reserve(blocks);
  }
};

/// Present estimate of the unknowns.
struct AlignmentState {
  RigidMotion motion;
  double gain = 1;
  double brightness = 0;
  double offset_px = 0;
  double growth_px = 0;
  double shutter = 0;
};

/// Linearises the differences of grey levels and of disparities between the points of a level of a reference and a
/// frame at `state`, on up to `threads` threads (0: all cores). Weights are left open.
void linearise(const std::vector<ReferencePoint>& points, const LinkMaps& current, const StereoCalibration& calibration,
               int level, const AlignmentState& state, int threads, AlignmentEquations& equations);

/// Adds the weighted products of every two elements of the equations' rows, the lower half of a matrix; the residual is
/// the last element of a row.
void add_products(const EquationBlocks& equations, Matrix<unknowns + 1>& sums);

}  // namespace roadstereo
