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

/// Six of the motion, gain and offset of the grey levels, offset of the disparities, by how much that offset grows
/// towards the sides more than its shape says, shutter.
inline constexpr std::size_t unknowns = 11;
inline constexpr std::size_t gain_index = 6, brightness_index = 7, offset_index = 8, growth_index = 9,
                             shutter_index = 10;

/// One equation: residual + row·x = 0.
struct AlignmentEquation {
  std::array<double, unknowns> row{};
  double residual = 0;
  double variance = 0;  ///< known part
  double total_variance = 0;
  double weight = 0;
  int cell = 0;
};

/// Equations of a level at the present motion.
struct AlignmentEquations {
  ScratchVector<AlignmentEquation> grey = scratch_vector<AlignmentEquation>();
  ScratchVector<AlignmentEquation> disparity = scratch_vector<AlignmentEquation>();
  double visible = 0;  ///< points, each by the area of what it stands for that is left
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
/// frame at `state`. Weights are left at 0.
void linearise(const std::vector<ReferencePoint>& points, const FrameMaps& current,
               const StereoCalibration& calibration, int level, const AlignmentState& state,
               AlignmentEquations& equations);

}  // namespace roadstereo
