#include "evaluate/sigma_calibration.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "finite_values.hpp"

namespace roadstereo::cli {
namespace {

constexpr double one_sigma_share = 0.683;  // of normal errors lie within σ

/// Share of the errors below `sigmas` standard errors.
double share_within(std::span<const SigmaSample> samples, float sigmas) {
  const auto within = std::count_if(samples.begin(), samples.end(), [sigmas](const SigmaSample& sample) {
    return sample.error_px < sigmas * sample.sigma_px;
  });
  return static_cast<double>(within) / static_cast<double>(samples.size());
}

std::vector<double> errors_of(std::span<const SigmaSample> samples) {
  std::vector<double> errors;
  errors.reserve(samples.size());
  for (const SigmaSample& sample : samples) errors.push_back(sample.error_px);
  return errors;
}

std::vector<double> sigmas_of(std::span<const SigmaSample> samples) {
  std::vector<double> sigmas;
  sigmas.reserve(samples.size());
  for (const SigmaSample& sample : samples) sigmas.push_back(sample.sigma_px);
  return sigmas;
}

}  // namespace

void add_sigma_samples(ImageView<const float> disparity, ImageView<const float> sigma, ImageView<const float> truth,
                       ImageView<const std::uint8_t> mask, std::vector<SigmaSample>& samples) {
  for (int v = 0; v < truth.height(); ++v) {
    for (int u = 0; u < truth.width(); ++u) {
      const float error = std::abs(disparity(u, v) - truth(u, v));
      if (mask(u, v) != 0 && std::isfinite(error)) samples.push_back({error, sigma(u, v)});
    }
  }
}

SigmaCalibration calibrate_sigma(const std::vector<SigmaSample>& samples) {
  return {samples.size(), share_within(samples, 1), share_within(samples, 2), median(errors_of(samples)),
          median(sigmas_of(samples))};
}

std::vector<SigmaBin> sigma_bins(std::vector<SigmaSample> samples, int bins) {
  std::sort(samples.begin(), samples.end(), [](const auto& a, const auto& b) { return a.sigma_px < b.sigma_px; });
  const auto count = static_cast<std::size_t>(bins);
  std::vector<SigmaBin> filled;
  for (std::size_t bin = 0; bin < count; ++bin) {
    const std::size_t first = bin * samples.size() / count;
    const std::size_t end = (bin + 1) * samples.size() / count;
    if (first == end) continue;
    const std::span<const SigmaSample> part(samples.data() + first, end - first);
    const std::vector<double> errors = errors_of(part);
    filled.push_back(
        {part.size(), median(sigmas_of(part)), quantile(errors, one_sigma_share), rms(errors), share_within(part, 2)});
  }
  return filled;
}

}  // namespace roadstereo::cli
