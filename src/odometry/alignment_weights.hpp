#pragma once

#include "odometry/alignment_equations.hpp"

namespace roadstereo {

/// Memory for weighing equations; nothing is allocated after it was made.
struct WeightMemory {
  ScratchVector<double> values;                 ///< for every equation
  ScratchVector<double> sums, counts, scratch;  ///< for every cell of the image

  WeightMemory(std::size_t blocks, std::size_t cells)
      : values(scratch_vector<double>(blocks * EquationBlock::lanes)),
        sums(scratch_vector<double>(cells)),
        counts(scratch_vector<double>(cells)),
        scratch(scratch_vector<double>(cells)) {}
};

/// Weights grey levels: their variance is that of the noise, estimated from the residuals, and that of the depths.
/// Tukey's biweight for each; cells that fit worse than most weigh less, and so do all where residuals of a cell are
/// correlated. `noise` is a first guess and becomes the estimate, grey levels.
void weigh_grey_levels(EquationBlocks& equations, double& noise, WeightMemory& memory);

/// Weights disparities alike: their variances are known up to a factor.
void weigh_disparities(EquationBlocks& equations, WeightMemory& memory);

}  // namespace roadstereo
