#include "core/block_grid.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <vector>

#include "core/deblocking.hpp"
#include "core/order_statistics.hpp"

namespace roadstereo {
namespace {

/// Sums of the absolute steps before every column, or every row, over some of the lines across.
using StepProfile = std::vector<std::int64_t>;

StepProfile steps_across(ImageView<const std::int16_t> image) {
  StepProfile steps(static_cast<std::size_t>(image.width()), 0);
  for (int v = 1; v < image.height(); v += BlockStepSamples::step) {
    const std::int16_t* const row = image.row(v);
    for (int u = 1; u < image.width(); ++u) steps[static_cast<std::size_t>(u)] += std::abs(row[u] - row[u - 1]);
  }
  return steps;
}

StepProfile steps_down(ImageView<const std::int16_t> image) {
  StepProfile steps(static_cast<std::size_t>(image.height()), 0);
  for (int v = 1; v < image.height(); ++v) {
    const std::int16_t *const row = image.row(v), *const above = image.row(v - 1);
    std::int64_t& sum = steps[static_cast<std::size_t>(v)];
    for (int u = 0; u < image.width(); u += BlockStepSamples::step) sum += std::abs(row[u] - above[u]);
  }
  return steps;
}

/// Borders of blocks in one direction.
struct Grid {
  double excess = 0;     ///< median over the borders
  double std_error = 0;  ///< of that median
  BlockSteps steps;
};

/// The borders at every eighth line from `phase` on.
Grid grid_at(const StepProfile& steps, std::size_t phase) {
  Grid grid;
  std::vector<double> excesses;
  for (std::size_t k = phase < 2 ? phase + jpeg_block : phase; k + 1 < steps.size(); k += jpeg_block) {
    const std::int64_t beside = steps[k - 1] + steps[k + 1];
    if (beside == 0) continue;
    excesses.push_back(BlockSteps{steps[k], beside}.excess());
    grid.steps.between += steps[k];
    grid.steps.beside += beside;
  }
  constexpr std::size_t min_borders = 8;  // fewer differ by chance
  if (excesses.size() < min_borders) return {};
  grid.excess = upper_median(std::vector(excesses));
  for (double& excess : excesses) excess -= grid.excess;
  constexpr double of_median = 1.2533;  // √(π/2): standard error of a median over that of a mean
  grid.std_error =
      of_median * gaussian_mad * upper_median_magnitude(excesses) / std::sqrt(static_cast<double>(excesses.size()));
  return grid;
}

Grid strongest_grid(const StepProfile& steps) {
  Grid best = grid_at(steps, 0);
  for (std::size_t phase = 1; phase < jpeg_block; ++phase) {
    const Grid grid = grid_at(steps, phase);
    if (grid.excess > best.excess) best = grid;
  }
  return best;
}

/// Largest of eight medians by chance: images that are not compressed have up to 0.03 in the weaker direction.
bool is_beyond_chance(const Grid& grid) {
  constexpr double min_excess = 0.05, min_sigmas = 3;
  return grid.excess > min_excess + min_sigmas * grid.std_error;
}

}  // namespace

double block_grid_excess(ImageView<const std::int16_t> image) {
  const Grid across = strongest_grid(steps_across(image)), down = strongest_grid(steps_down(image));
  if (!is_beyond_chance(across) || !is_beyond_chance(down)) return 0;
  return BlockSteps{across.steps.between + down.steps.between, across.steps.beside + down.steps.beside}.excess();
}

}  // namespace roadstereo
