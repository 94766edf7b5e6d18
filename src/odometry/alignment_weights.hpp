#pragma once

#include "odometry/alignment_equations.hpp"

namespace roadstereo {

/// Weights grey levels: their variance is that of the noise, estimated from the residuals, and that of the depths.
/// Tukey's biweight for each; cells that fit worse than most weigh less, and so do all where residuals of a cell are
/// correlated. `sums` has a place for every cell; `noise` is a first guess and becomes the estimate, grey levels.
void weigh_grey_levels(EquationBlocks& equations, double& noise, ScratchVector<double>& sums,
                       ScratchVector<double>& scratch);

/// Weights disparities alike: their variances are known up to a factor.
void weigh_disparities(EquationBlocks& equations, ScratchVector<double>& sums, ScratchVector<double>& scratch);

}  // namespace roadstereo
