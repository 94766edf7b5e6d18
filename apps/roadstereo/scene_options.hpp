#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "roadstereo/synth.hpp"

namespace CLI {
class App;
}

namespace roadstereo::cli {

/// Command line options of the scene; absent ones keep the value of the scene.
struct SceneOptions {
  std::string name;                     ///< empty: "demo", or a plain random road when there is a seed
  std::optional<std::uint64_t> seed{};  ///< of a random scene
  bool degraded = false;                ///< random image degradation
  std::optional<std::string> size{};    ///< "WxH"
  std::optional<double> camera_height_m{};
  std::optional<double> pitch_deg{};
  std::optional<double> roll_deg{};
  std::optional<double> focal_px{};
  std::optional<double> baseline_m{};
  std::optional<double> noise_grey{};
  std::optional<double> blur_px{};
  std::optional<double> gain_difference{};
  std::optional<double> exposure{};
  std::optional<int> supersampling{};  ///< rays per pixel and axis of the renderer
};

/// Adds the options to a subcommand.
void add_scene_options(CLI::App& command, SceneOptions& options);

/// Returns the scene. Throws Error for an unknown name or a value out of range.
synth::Scene make_scene(const SceneOptions& options);

}  // namespace roadstereo::cli
