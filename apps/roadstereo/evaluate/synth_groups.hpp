#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pair_source.hpp"
#include "roadstereo/synth.hpp"

namespace CLI {
class App;
}

namespace roadstereo::cli {

/// Add --sizes, which selects the set of synth_scenes.
void add_synth_sizes(CLI::App& command, std::string& sizes);

/// Group of rendered pairs with one kind of degradation.
struct SynthGroup {
  std::string name;
  void (*degrade)(synth::Scene& scene) = nullptr;
};

/// All groups: "clean" first, then one kind of degradation each.
const std::vector<SynthGroup>& synth_groups();

/// Scenes of every group: named and random scenes of 640×360 pixels; the small set has three scenes of 320×180.
std::vector<synth::Scene> synth_scenes(bool small);

/// Rendered pair with ground truth and masks.
struct SynthCase {
  StereoPair pair;
  Image<float> truth;           ///< disparity, pixels
  Image<std::uint8_t> visible;  ///< 255 where both cameras see the point
  Image<std::uint8_t> damage;   ///< 255 where both cameras see the point and it lies on damage
  int disparities = 0;          ///< number of disparities that includes the maximum of the truth
};

/// Name of the files of a scene: the group's, with "_" for spaces, and the number of the scene.
std::string synth_frame(const SynthGroup& group, std::size_t scene);

/// Degrade and render a scene.
SynthCase make_synth_case(const SynthGroup& group, synth::Scene scene, int threads);

}  // namespace roadstereo::cli
