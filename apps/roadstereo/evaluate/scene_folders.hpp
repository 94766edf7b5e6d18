// Folders of one synthetic scene each: left.png, right.png, disparity.tiff (float, NaN none), occ.png (255 seen by both
// cameras), region.png (1 road, 2 damage), and optionally calibration.yaml, damage.png (16 bit, labels) and truth.json.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "evaluate/labelled_frame.hpp"
#include "roadstereo/synth.hpp"

namespace roadstereo::cli {

bool is_scene_folder(const std::filesystem::path& folder);

/// The scenes in a folder, by name.
std::vector<std::filesystem::path> scene_folders(const std::filesystem::path& folder);

/// The pair of a scene and its truth. The road is road and damage that both cameras see.
LabelledFrame read_scene_folder(const std::filesystem::path& folder);

/// Kinds of damage of rendered roads.
inline constexpr std::array scene_kinds{"pothole", "bump", "crack", "rut"};

/// What damage.png and truth.json tell of the damage of a scene.
struct SceneTruth {
  Image<std::uint16_t> labels;  ///< id of the damage at the pixel; 0: none
  std::vector<synth::DamageTruth> damages;
  double camera_height_m = 0;
};

/// Throws Error naming the file if it is missing, has a damage of another kind, or the labels do not have the size of
/// `disparity`.
SceneTruth read_scene_truth(const std::filesystem::path& folder, const Image<float>& disparity);

}  // namespace roadstereo::cli
