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

/// Adds --sizes, which chooses between the sets of synth_scenes.
void add_synth_sizes(CLI::App& command, std::string& sizes);

/// What makes the pairs of a group hard.
struct SynthGroup {
  std::string name;
  void (*wear)(synth::Scene& scene) = nullptr;
  int jpeg_quality = 0;  ///< 0 compresses nothing
};

/// "clean" first, then everything that can spoil a pair, one thing at a time.
const std::vector<SynthGroup>& synth_groups();

/// The roads that every group shows: named scenes and some drawn at random, 640×360; the small set has three at
/// 320×180.
std::vector<synth::Scene> synth_scenes(bool small);

/// One pair with what it is scored on.
struct SynthCase {
  StereoPair pair;
  Image<float> truth;
  Image<std::uint8_t> visible;  ///< 255 where both cameras see the point
  Image<std::uint8_t> damage;   ///< 255 where such a point lies on damage
  int disparities = 0;          ///< that hold the largest true disparity
};

SynthCase make_synth_case(const SynthGroup& group, synth::Scene scene, int threads);

}  // namespace roadstereo::cli
