#include "odometry/alignment_weights.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/order_statistics.hpp"
#include "core/tukey.hpp"

namespace roadstereo {
namespace {

/// Lowers the weights of cells whose residuals are larger than those of most cells: something moves there, or is seen
/// by one frame only. A single residual cannot tell, since a wrong grey level may fit by chance.
void weigh_cells(ScratchVector<AlignmentEquation>& equations, ScratchVector<double>& squares,
                 ScratchVector<double>& scratch) {
  constexpr double usual_spread = 1.5;  // of the mean squares of cells that fit
  auto counts = scratch_vector<double>(squares.size());
  std::fill(squares.begin(), squares.end(), 0.0);
  for (const AlignmentEquation& e : equations) {
    squares[static_cast<std::size_t>(e.cell)] += e.residual * e.residual / e.total_variance;
    counts[static_cast<std::size_t>(e.cell)] += 1;
  }
  scratch.clear();
  for (std::size_t i = 0; i < squares.size(); ++i) {
    if (counts[i] > 0) scratch.push_back(squares[i] /= counts[i]);
  }
  const double limit = usual_spread * std::max(upper_median(scratch), 1.0);  // 1: as their variances say
  for (AlignmentEquation& e : equations) {
    const double ratio = limit / std::max(squares[static_cast<std::size_t>(e.cell)], limit);
    e.weight *= ratio * ratio;
  }
}

/// How many times the variance of sums of a cell exceeds that of independent residuals.
double correlation_factor(const ScratchVector<AlignmentEquation>& equations, ScratchVector<double>& sums) {
  std::fill(sums.begin(), sums.end(), 0.0);
  double squares = 0;
  for (const AlignmentEquation& e : equations) {
    const double z = std::sqrt(e.weight) * e.residual;
    sums[static_cast<std::size_t>(e.cell)] += z;
    squares += z * z;
  }
  double of_sums = 0;
  for (const double sum : sums) of_sums += sum * sum;
  return squares > 0 ? std::max(of_sums / squares, 1.0) : 1;
}

void divide_weights(ScratchVector<AlignmentEquation>& equations, double factor) {
  for (AlignmentEquation& e : equations) e.weight /= factor;
}

}  // namespace

void weigh_grey_levels(ScratchVector<AlignmentEquation>& equations, double& noise, ScratchVector<double>& sums,
                       ScratchVector<double>& scratch) {
  constexpr double min_noise = 0.3;  // grey levels: that of rounding to 8 bits
  scratch.clear();
  for (const AlignmentEquation& e : equations)
    scratch.push_back(e.residual * noise / std::sqrt(noise * noise + e.variance));
  noise = std::max(gaussian_mad * upper_median_magnitude(scratch), min_noise);
  for (AlignmentEquation& e : equations) {
    e.total_variance = noise * noise + e.variance;
    e.weight = tukey_weight(e.residual / (tukey * std::sqrt(e.total_variance))) / e.total_variance;
  }
  weigh_cells(equations, sums, scratch);
  divide_weights(equations, correlation_factor(equations, sums));
}

void weigh_disparities(ScratchVector<AlignmentEquation>& equations, ScratchVector<double>& sums,
                       ScratchVector<double>& scratch) {
  scratch.clear();
  for (const AlignmentEquation& e : equations) scratch.push_back(e.residual / std::sqrt(e.variance));
  constexpr double min_factor = 0.5;
  const double factor = std::max(gaussian_mad * upper_median_magnitude(scratch), min_factor);
  for (AlignmentEquation& e : equations) {
    e.total_variance = factor * factor * e.variance;
    e.weight = tukey_weight(e.residual / (tukey * std::sqrt(e.total_variance))) / e.total_variance;
  }
  weigh_cells(equations, sums, scratch);
  divide_weights(equations, correlation_factor(equations, sums));
}

}  // namespace roadstereo
