#include "evaluate/subpixel_trials.hpp"

#include <array>
#include <cmath>

#include "evaluate/wave_road.hpp"
#include "progress.hpp"

namespace roadstereo::cli {
namespace {

constexpr int baseline_disparities = 48;  // for OpenCV's matchers

struct MethodMap {
  Image<float> disparity;
  PerspectiveShift shift;  ///< disabled for OpenCV's matchers
};

MethodMap match(const std::string& method, const StereoPair& pair, const MethodSettings& settings) {
  const MethodTask task{pair, baseline_disparities};
  if (!is_preset(method)) {
    PerspectiveShift none;
    none.enabled = false;
    return {run_method(method, task, settings), none};
  }
  Pipeline pipeline(method_options(method, task, settings), pair.calibration);
  const FrameResult& result = pipeline.process(pair.left.view(), pair.right.view());
  return {result.disparity, result.shift};
}

/// Disparities of the transformed pair: those of the pair without the shift of the target's pixel.
Image<float> residual_of(ImageView<const float> disparity, const PerspectiveShift& shift) {
  Image<float> residual(disparity.width(), disparity.height());
  for (int v = 0; v < disparity.height(); ++v) {
    for (int u = 0; u < disparity.width(); ++u) {
      const double of_road = disparity(u, v) - shift.at(u, v);
      residual(u, v) = static_cast<float>(disparity(u, v) - shift.at(u - of_road, v));
    }
  }
  return residual;
}

double valid_share(ImageView<const float> disparity, ImageView<const std::uint8_t> mask) {
  double pixels = 0, valid = 0;
  for (int v = 0; v < disparity.height(); ++v) {
    for (int u = 0; u < disparity.width(); ++u) {
      pixels += mask(u, v) != 0 ? 1 : 0;
      valid += mask(u, v) != 0 && std::isfinite(disparity(u, v)) ? 1 : 0;
    }
  }
  return valid / pixels;
}

void add_shots(const WaveRoad& road, const std::array<StereoPair, 2>& shots, const MethodSettings& settings,
               SubPixelTrial& trial) {
  std::array<Image<float>, 2> maps;
  for (std::size_t shot = 0; shot < shots.size(); ++shot) {
    MethodMap map = match(trial.method, shots[shot], settings);
    trial.bias.add(residual_of(map.disparity, map.shift), residual_of(road.truth(), map.shift), road.inside());
    trial.valid_share += valid_share(map.disparity, road.inside());
    maps[shot] = std::move(map.disparity);
  }
  const double rounding_grey = 1 / std::sqrt(12.0);
  trial.noise.add(maps[0], maps[1], road.derivative(), road.inside(), std::hypot(trial.noise_grey, rounding_grey));
}

}  // namespace

std::vector<SubPixelTrial> measure_subpixel(int roads, const std::vector<double>& noises_grey,
                                            const MethodSettings& settings) {
  std::vector<SubPixelTrial> trials;
  for (const double noise : noises_grey) {
    for (const std::string& method : method_names()) trials.push_back({method, noise});
  }
  Progress progress = Progress::on_terminal(static_cast<std::size_t>(roads) * trials.size());
  for (int i = 0; i < roads; ++i) {
    const auto seed = static_cast<std::uint64_t>(i);
    const WaveRoad road(seed, settings.threads);
    for (SubPixelTrial& trial : trials) {
      add_shots(road, {road.shot(trial.noise_grey, 2 * seed), road.shot(trial.noise_grey, 2 * seed + 1)}, settings,
                trial);
      progress.frame_done();
    }
  }
  for (SubPixelTrial& trial : trials) trial.valid_share /= 2 * roads;
  return trials;
}

}  // namespace roadstereo::cli
