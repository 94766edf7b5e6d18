#include "odometry/alignment_weights.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/order_statistics.hpp"
#include "core/tukey.hpp"

namespace roadstereo {
namespace {

constexpr std::size_t lanes = EquationBlock::lanes;

/// Values of the equations, computed for whole blocks.
template <class Value>
void collect(const EquationBlocks& equations, ScratchVector<double>& values, const Value& value_of) {
  values.resize(equations.size() * lanes);
  std::size_t count = 0;
  for (const EquationBlock& block : equations) {
    EquationBlock::Lanes all;
    for (std::size_t i = 0; i < lanes; ++i) all[i] = value_of(block.residual[i], block.variance[i]);
    for (std::size_t i = 0; i < lanes; ++i) {
      values[count] = all[i];
      count += block.valid[i] ? 1 : 0;
    }
  }
  values.resize(count);
}

/// Tukey's biweight by the total variance, which `total_of` tells from the known part.
template <class Total>
void weigh_residuals(EquationBlocks& equations, const Total& total_of) {
  for (EquationBlock& block : equations) {
    for (std::size_t i = 0; i < lanes; ++i) {
      const double total = total_of(block.variance[i]);
      const double weight = tukey_weight(block.residual[i] / (tukey * std::sqrt(total))) / total;
      block.total_variance[i] = total;
      block.weight[i] = block.valid[i] ? weight : 0;
    }
  }
}

/// Lowers the weights of cells whose residuals are larger than those of most cells: something moves there, or is seen
/// by one frame only. A single residual cannot tell, since a wrong grey level may fit by chance.
void weigh_cells(EquationBlocks& equations, WeightMemory& memory) {
  constexpr double usual_spread = 1.5;  // of the mean squares of cells that fit
  ScratchVector<double>&squares = memory.sums, &counts = memory.counts, &scratch = memory.scratch;
  std::fill(squares.begin(), squares.end(), 0.0);
  std::fill(counts.begin(), counts.end(), 0.0);
  for (const EquationBlock& block : equations) {
    for (std::size_t i = 0; i < lanes; ++i) {
      if (!block.valid[i]) continue;
      squares[static_cast<std::size_t>(block.cell[i])] +=
          block.residual[i] * block.residual[i] / block.total_variance[i];
      counts[static_cast<std::size_t>(block.cell[i])] += 1;
    }
  }
  scratch.clear();
  for (std::size_t i = 0; i < squares.size(); ++i) {
    if (counts[i] > 0) scratch.push_back(squares[i] /= counts[i]);
  }
  const double limit = usual_spread * std::max(upper_median(scratch), 1.0);  // 1: as their variances say
  for (double& square : squares) {
    const double ratio = limit / std::max(square, limit);
    square = ratio * ratio;
  }
  for (EquationBlock& block : equations) {
    for (std::size_t i = 0; i < lanes; ++i) block.weight[i] *= squares[static_cast<std::size_t>(block.cell[i])];
  }
}

/// How many times the variance of sums of a cell exceeds that of independent residuals.
double correlation_factor(const EquationBlocks& equations, ScratchVector<double>& sums) {
  std::fill(sums.begin(), sums.end(), 0.0);
  double squares = 0;
  for (const EquationBlock& block : equations) {
    EquationBlock::Lanes z;
    for (std::size_t i = 0; i < lanes; ++i) z[i] = std::sqrt(block.weight[i]) * block.residual[i];
    for (std::size_t i = 0; i < lanes; ++i) {
      sums[static_cast<std::size_t>(block.cell[i])] += z[i];
      squares += z[i] * z[i];
    }
  }
  double of_sums = 0;
  for (const double sum : sums) of_sums += sum * sum;
  return squares > 0 ? std::max(of_sums / squares, 1.0) : 1;
}

void divide_weights(EquationBlocks& equations, double factor) {
  for (EquationBlock& block : equations) {
    for (double& weight : block.weight) weight /= factor;
  }
}

}  // namespace

void weigh_grey_levels(EquationBlocks& equations, double& noise, WeightMemory& memory) {
  constexpr double min_noise = 0.3;  // grey levels: that of rounding to 8 bits
  const double before = noise;
  collect(equations, memory.values, [before](double residual, double variance) {
    return residual * before / std::sqrt(before * before + variance);
  });
  noise = std::max(gaussian_mad * upper_median_magnitude(memory.values), min_noise);
  weigh_residuals(equations, [now = noise](double variance) { return now * now + variance; });
  weigh_cells(equations, memory);
  divide_weights(equations, correlation_factor(equations, memory.sums));
}

void weigh_disparities(EquationBlocks& equations, WeightMemory& memory) {
  collect(equations, memory.values, [](double residual, double variance) { return residual / std::sqrt(variance); });
  if (memory.values.empty()) {
    for (EquationBlock& block : equations) block.weight.fill(0);
    return;
  }
  constexpr double min_factor = 0.5;
  const double factor = std::max(gaussian_mad * upper_median_magnitude(memory.values), min_factor);
  weigh_residuals(equations, [factor](double variance) { return factor * factor * variance; });
  weigh_cells(equations, memory);
  divide_weights(equations, correlation_factor(equations, memory.sums));
}

}  // namespace roadstereo
