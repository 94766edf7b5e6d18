#include "benchmark_frames.hpp"

#include <utility>
#include <vector>

#include "roadstereo/synth.hpp"

namespace roadstereo::cli {

StereoPair synthetic_pair(int width, int height) {
  synth::Scene scene = synth::named_scene("uav");
  scene.supersampling = 1;
  scene.rig.focal_px *= static_cast<double>(width) / scene.rig.width;
  scene.rig.width = width;
  scene.rig.height = height;
  synth::SyntheticPair made = synth::render(scene);
  StereoPair pair;
  pair.left = std::move(made.left);
  pair.right = std::move(made.right);
  pair.calibration = made.calibration;
  return pair;
}

PeerPair peer_pair(const StereoPair& pair, const PerspectiveShift& shift) {
  PeerPair baselines;
  GreyImage right;
  std::vector<int> first_column;
  to_grey(pair.left.view(), pair.white_level, baselines.reference);
  to_grey(pair.right.view(), pair.white_level, right);
  transform_target(right, shift, 0, baselines.target, first_column);
  return baselines;
}

}  // namespace roadstereo::cli
