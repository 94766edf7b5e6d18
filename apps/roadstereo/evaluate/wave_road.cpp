#include "evaluate/wave_road.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/parallel.hpp"
#include "synth/hash.hpp"

namespace roadstereo::cli {
namespace {

constexpr int wave_count = 256;
constexpr double shortest_px = 4, longest_px = 128;  // wavelengths
constexpr double mean_grey = 120;
constexpr double far_disparity_px = 10, near_disparity_px = 30;  // of the first row and of the last
constexpr double roof_px = 1;                                    // disparities reach as far from the plane, both ways
constexpr int margin_px = 40;  // what the windows of no matcher cross: from the border and the ridge

/// cos(u·along_u + v·along_v + phase); radians.
struct Wave {
  double along_u = 0, along_v = 0, phase = 0;
};

/// Grey level and its derivative along the row.
struct GreyLevel {
  double value = 0, derivative = 0;
};

class WaveTexture {
 public:
  explicit WaveTexture(std::uint64_t seed) {
    synth::RandomSequence random(seed);
    for (Wave& wave : waves_) {
      const double wavelength = shortest_px * std::pow(longest_px / shortest_px, random.uniform(0, 1));
      const double direction = random.uniform(0, std::numbers::pi), frequency = 2 * std::numbers::pi / wavelength;
      wave = {frequency * std::cos(direction), frequency * std::sin(direction),
              random.uniform(0, 2 * std::numbers::pi)};
    }
  }

  GreyLevel at(double u, double v) const {
    GreyLevel grey{mean_grey, 0};
    const double amplitude = WaveRoad::contrast_grey * std::sqrt(2.0 / wave_count);
    for (const Wave& wave : waves_) {
      const double phase = wave.along_u * u + wave.along_v * v + wave.phase;
      grey.value += amplitude * std::cos(phase);
      grey.derivative -= amplitude * wave.along_u * std::sin(phase);
    }
    return grey;
  }

 private:
  std::array<Wave, wave_count> waves_;
};

double plane_disparity(int v) {
  return far_disparity_px + (near_disparity_px - far_disparity_px) * v / (WaveRoad::height - 1);
}

constexpr double ridge = 0.5 * (WaveRoad::width - 1);
constexpr double slope = 4 * roof_px / WaveRoad::width;  // of the disparities to either side of the ridge

double disparity(double u, int v) {
  return plane_disparity(v) - roof_px + slope * std::abs(u - ridge);
}

/// Column of the left image that column x of the right one shows: the inverse of x = u − disparity(u, v).
double left_column(double x, int v) {
  const double from_ridge = x - ridge + plane_disparity(v) - roof_px;
  return ridge + from_ridge / (from_ridge < 0 ? 1 + slope : 1 - slope);
}

Frame take_picture(const Image<float>& grey, double noise_grey, std::uint64_t seed) {
  Frame frame{{}, grey.width(), grey.height()};
  std::uint64_t key = synth::mix64(seed);
  for (int v = 0; v < grey.height(); ++v) {
    for (int u = 0; u < grey.width(); ++u) {
      const double value = std::round(grey(u, v) + noise_grey * synth::normal_value(key++));
      frame.bytes.push_back(static_cast<std::uint8_t>(std::clamp(value, 0.0, 255.0)));
    }
  }
  return frame;
}

}  // namespace

WaveRoad::WaveRoad(std::uint64_t seed, int threads)
    : left_(width, height),
      right_(width, height),
      truth_(width, height),
      derivative_(width, height),
      inside_(width, height) {
  const WaveTexture texture(seed);
  parallel_for(height, threads, [&](int v, int) {
    for (int u = 0; u < width; ++u) {
      const GreyLevel left = texture.at(u, v);
      left_(u, v) = static_cast<float>(left.value);
      derivative_(u, v) = static_cast<float>(left.derivative);
      right_(u, v) = static_cast<float>(texture.at(left_column(u, v), v).value);
      truth_(u, v) = static_cast<float>(disparity(u, v));
      const bool beside_ridge = std::abs(u - ridge) > margin_px;
      const bool within =
          u >= near_disparity_px + margin_px && u < width - margin_px && v >= margin_px && v < height - margin_px;
      inside_(u, v) = within && beside_ridge ? 255 : 0;
    }
  });
}

StereoPair WaveRoad::shot(double noise_grey, std::uint64_t noise_seed) const {
  StereoPair pair;
  pair.left = take_picture(left_, noise_grey, 2 * noise_seed);
  pair.right = take_picture(right_, noise_grey, 2 * noise_seed + 1);
  return pair;
}

}  // namespace roadstereo::cli
