#include "evaluation/sub_pixel_bias.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/require_size.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo {

SubPixelBias::SubPixelBias(int bins) {
  if (bins < 2) fail("the number of phase bins is ", bins, "; it must be at least 2");
  bins_.resize(static_cast<std::size_t>(bins));
}

void SubPixelBias::add(ImageView<const float> disparity, ImageView<const float> truth,
                       ImageView<const std::uint8_t> mask) {
  require_same_size("the ground truth", map_size(truth), "the disparity map", map_size(disparity));
  require_same_size("the ground truth", map_size(truth), "the mask", map_size(mask));
  constexpr double max_error_px = 1;  // larger errors are mismatches
  for (int v = 0; v < truth.height(); ++v) {
    for (int u = 0; u < truth.width(); ++u) {
      const double true_disparity = truth(u, v);
      const double error = disparity(u, v) - true_disparity;
      const bool is_match = mask(u, v) != 0 && std::abs(error) <= max_error_px;  // false for NaN
      if (!is_match) continue;
      const double phase = true_disparity - std::floor(true_disparity);
      const auto bin = static_cast<std::size_t>(phase * static_cast<double>(bins_.size()));
      bins_[std::min(bin, bins_.size() - 1)].sum_px += error;
      bins_[std::min(bin, bins_.size() - 1)].count += 1;
    }
  }
}

std::vector<double> SubPixelBias::phases() const {
  std::vector<double> phases;
  for (std::size_t i = 0; i < bins_.size(); ++i) {
    phases.push_back((static_cast<double>(i) + 0.5) / static_cast<double>(bins_.size()));
  }
  return phases;
}

std::vector<double> SubPixelBias::means_px() const {
  std::vector<double> means;
  for (const Bin& bin : bins_) {
    means.push_back(bin.count > 0 ? bin.sum_px / bin.count : std::numeric_limits<double>::quiet_NaN());
  }
  return means;
}

double SubPixelBias::ripple_px() const {
  std::vector<double> means = means_px();
  std::erase_if(means, [](double mean) { return std::isnan(mean); });
  if (means.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto [min, max] = std::minmax_element(means.begin(), means.end());
  return *max - *min;
}

}  // namespace roadstereo
