#include "synth/degradation.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/degrees.hpp"
#include "core/parallel.hpp"
#include "synth/hash.hpp"

namespace roadstereo::synth {
namespace {

constexpr int rows_per_band = 16;

/// Gaussian kernel, truncated at 4 standard deviations; sums to 1.
std::vector<double> gaussian_kernel(double sigma) {
  const int radius = std::max(1, static_cast<int>(std::ceil(4 * sigma)));
  std::vector<double> weights;
  double sum = 0;
  for (int i = -radius; i <= radius; ++i) {
    weights.push_back(std::exp(-0.5 * i * i / (sigma * sigma)));
    sum += weights.back();
  }
  for (double& weight : weights) weight /= sum;
  return weights;
}

/// Convolve along the rows, or along the columns if `vertical`. The border is replicated.
void convolve(const Image<float>& in, const std::vector<double>& kernel, bool vertical, int threads,
              Image<float>& out) {
  const int radius = static_cast<int>(kernel.size() / 2);
  const double* centre = kernel.data() + radius;
  out.resize(in.width(), in.height());
  parallel_rows(in.height(), rows_per_band, threads, [&](int first, int last, int) {
    for (int v = first; v < last; ++v) {
      for (int u = 0; u < in.width(); ++u) {
        double sum = 0;
        for (int i = -radius; i <= radius; ++i) {
          const int column = vertical ? u : std::clamp(u + i, 0, in.width() - 1);
          const int row = vertical ? std::clamp(v + i, 0, in.height() - 1) : v;
          sum += centre[i] * static_cast<double>(in(column, row));
        }
        out(u, v) = static_cast<float>(sum);
      }
    }
  });
}

/// Bilinear interpolation; the border is replicated.
double bilinear(const Image<float>& image, double u, double v) {
  u = std::clamp(u, 0.0, image.width() - 1.0);
  v = std::clamp(v, 0.0, image.height() - 1.0);
  const int left = std::min(static_cast<int>(u), image.width() - 2);
  const int top = std::min(static_cast<int>(v), image.height() - 2);
  const double a = u - left;
  const double b = v - top;
  const auto at = [&](int du, int dv) { return static_cast<double>(image(left + du, top + dv)); };
  return (1 - b) * ((1 - a) * at(0, 0) + a * at(1, 0)) + b * ((1 - a) * at(0, 1) + a * at(1, 1));
}

/// Linear motion blur: mean over taps along the motion.
void motion_blur(const Image<float>& in, double length, double angle_deg, int threads, Image<float>& out) {
  const int taps = 2 * static_cast<int>(std::ceil(length)) + 1;
  const double angle = to_radians(angle_deg);
  const double step_u = std::cos(angle) * length / taps;
  const double step_v = std::sin(angle) * length / taps;
  out.resize(in.width(), in.height());
  parallel_rows(in.height(), rows_per_band, threads, [&](int first, int last, int) {
    for (int v = first; v < last; ++v) {
      for (int u = 0; u < in.width(); ++u) {
        double sum = 0;
        for (int i = 0; i < taps; ++i) {
          const double along = i - (taps - 1) / 2.0;
          sum += bilinear(in, u + along * step_u, v + along * step_v);
        }
        out(u, v) = static_cast<float>(sum / taps);
      }
    }
  });
}

/// Scale, add Gaussian noise of `noise_grey` and of the photons, clip and quantise to 8 bits.
Frame quantise(const Image<float>& irradiance, double scale, const Degradation& degradation, std::uint64_t noise_key,
               int threads) {
  // Of n electrons the variance is n: in grey levels, white / full well times the signal.
  constexpr double white = 255;
  const double photon_variance = degradation.full_well_electrons > 0 ? white / degradation.full_well_electrons : 0;
  const double read_variance = degradation.noise_grey * degradation.noise_grey;
  Frame frame;
  frame.width = irradiance.width();
  frame.height = irradiance.height();
  frame.bytes.resize(irradiance.pixels());
  parallel_rows(irradiance.height(), rows_per_band, threads, [&](int first, int last, int) {
    for (int v = first; v < last; ++v) {
      for (int u = 0; u < irradiance.width(); ++u) {
        const auto pixel =
            static_cast<std::size_t>(v) * static_cast<std::size_t>(irradiance.width()) + static_cast<std::size_t>(u);
        double grey = static_cast<double>(irradiance(u, v)) * scale;
        const double variance = read_variance + photon_variance * std::max(0.0, grey);
        if (variance > 0) grey += std::sqrt(variance) * normal_value(mix64(noise_key) + pixel);
        frame.bytes[pixel] = static_cast<std::uint8_t>(std::clamp(grey + 0.5, 0.0, 255.0));
      }
    }
  });
  return frame;
}

}  // namespace

Frame simulate_camera(Image<float>& irradiance, const Degradation& degradation, double gain, std::uint64_t noise_key,
                      int threads) {
  Image<float> scratch;
  if (degradation.blur_px > 0) {
    const std::vector<double> kernel = gaussian_kernel(degradation.blur_px);
    convolve(irradiance, kernel, false, threads, scratch);
    convolve(scratch, kernel, true, threads, irradiance);
  }
  if (degradation.motion_blur_px > 0) {
    motion_blur(irradiance, degradation.motion_blur_px, degradation.motion_blur_angle_deg, threads, scratch);
    std::swap(irradiance, scratch);
  }
  return quantise(irradiance, gain * degradation.exposure, degradation, noise_key, threads);
}

}  // namespace roadstereo::synth
