#include "roadstereo/sub_pixel_bias.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "roadstereo/error.hpp"

namespace roadstereo {

SubPixelBias::SubPixelBias(int bins) {
  if (bins < 2) fail("the phase of the disparities is split into ", bins, " bins; it takes at least 2");
  bins_.resize(static_cast<std::size_t>(bins));
}

void SubPixelBias::add(ImageView<const float> disparity, ImageView<const float> truth,
                       ImageView<const std::uint8_t> mask) {
  const auto has_size_of_truth = [&](const auto& image) {
    return image.width() == truth.width() && image.height() == truth.height();
  };
  if (!has_size_of_truth(disparity) || !has_size_of_truth(mask)) {
    fail("map, truth (", truth.width(), "×", truth.height(), ") and mask differ in size");
  }
  constexpr double gross_px = 1;
  for (int v = 0; v < truth.height(); ++v) {
    for (int u = 0; u < truth.width(); ++u) {
      const double real = truth(u, v);
      const double error = disparity(u, v) - real;
      const bool counts = mask(u, v) != 0 && std::abs(error) <= gross_px;  // not when either is NaN
      if (!counts) continue;
      const double phase = real - std::floor(real);
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
  const auto [least, most] = std::minmax_element(means.begin(), means.end());
  return *most - *least;
}

}  // namespace roadstereo
