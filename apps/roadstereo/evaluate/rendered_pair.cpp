#include "evaluate/rendered_pair.hpp"

#include <algorithm>

#include "roadstereo/io/image_file.hpp"

namespace roadstereo::cli {

synth::SyntheticPair render_recorded(const synth::Scene& scene, int threads) {
  synth::SyntheticPair rendered = synth::render(scene, threads);
  if (const int quality = scene.degradation.jpeg_quality; quality > 0) {
    rendered.left = io::with_jpeg_loss(rendered.left, quality);
    rendered.right = io::with_jpeg_loss(rendered.right, quality);
  }
  return rendered;
}

StereoPair pair_of(const synth::SyntheticPair& rendered) {
  StereoPair pair;
  pair.left = rendered.left;
  pair.right = rendered.right;
  pair.calibration = rendered.calibration;
  return pair;
}

Image<float> exact_map(const synth::SyntheticPair& rendered) {
  const Image<double>& disparity = rendered.disparity;
  Image<float> map(disparity.width(), disparity.height());
  std::transform(disparity.row(0), disparity.row(0) + disparity.pixels(), map.row(0),
                 [](double value) { return static_cast<float>(value); });
  return map;
}

}  // namespace roadstereo::cli
