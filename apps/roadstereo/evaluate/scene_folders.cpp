#include "evaluate/scene_folders.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/require_size.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/io/image_file.hpp"

namespace roadstereo::cli {
namespace {

namespace fs = std::filesystem;

/// 8-bit grey image.
Frame read_labels(const fs::path& path, const ImageSize& size) {
  Frame labels = io::read_frame(path.string());
  if (labels.sample != SampleType::u8 || labels.order != ChannelOrder::grey) fail(path.string(), " is not 8-bit grey");
  require_same_size(path.c_str(), {labels.width, labels.height}, "the pair", size);
  return labels;
}

Image<std::uint16_t> read_damage_labels(const std::string& path, const Image<float>& like) {
  const Frame file = io::read_frame(path);
  if (file.order != ChannelOrder::grey) fail(path, " is not grey");
  require_same_size(path.c_str(), {file.width, file.height}, "the disparities", map_size(like));
  Image<std::uint16_t> labels(file.width, file.height);
  if (file.sample == SampleType::u8) {
    std::copy(file.bytes.begin(), file.bytes.end(), labels.row(0));
  } else {
    std::memcpy(labels.row(0), file.bytes.data(), file.bytes.size());
  }
  return labels;
}

}  // namespace

bool is_scene_folder(const fs::path& folder) {
  constexpr std::array names{"left.png", "right.png", "disparity.tiff", "occ.png", "region.png"};
  return std::all_of(names.begin(), names.end(), [&](const char* name) { return fs::exists(folder / name); });
}

std::vector<fs::path> scene_folders(const fs::path& folder) {
  std::vector<fs::path> scenes;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.is_directory() && is_scene_folder(entry.path())) scenes.push_back(entry.path());
  }
  std::sort(scenes.begin(), scenes.end());
  return scenes;
}

LabelledFrame read_scene_folder(const fs::path& folder) {
  constexpr std::uint8_t road = 1, damage = 2, seen_by_both = 255;
  LabelledFrame frame;
  PairFiles files{(folder / "left.png").string(), (folder / "right.png").string(), {}};
  if (fs::exists(folder / "calibration.yaml")) files.calibration.push_back((folder / "calibration.yaml").string());
  frame.pair = read_pair(files);
  const ImageSize size{frame.pair.left.width, frame.pair.left.height};
  const std::string truth = (folder / "disparity.tiff").string();
  frame.truth = io::read_disparity(truth);
  require_same_size(truth.c_str(), map_size(frame.truth), "the pair", size);
  frame.disparities = disparities_of(frame.truth, 0);
  const Frame region = read_labels(folder / "region.png", size);
  const Frame seen = read_labels(folder / "occ.png", size);
  frame.road.emplace(region.width, region.height, std::uint8_t{0});
  for (std::size_t i = 0; i < region.bytes.size(); ++i) {
    const bool on_road = region.bytes[i] == road || region.bytes[i] == damage;
    frame.road->row(0)[i] = on_road && seen.bytes[i] == seen_by_both ? 255 : 0;
  }
  return frame;
}

SceneTruth read_scene_truth(const fs::path& folder, const Image<float>& disparity) {
  SceneTruth scene;
  scene.labels = read_damage_labels((folder / "damage.png").string(), disparity);
  const std::string path = (folder / "truth.json").string();
  try {
    const auto truth = nlohmann::json::parse(std::ifstream(path));
    scene.camera_height_m = truth.at("height_m");
    for (const auto& damage : truth.at("damages")) {
      synth::DamageTruth one;
      one.id = damage.at("label");
      one.kind = damage.at("kind");
      if (one.kind == "alligator") one.kind = "crack";  // a net of cracks
      if (std::find(scene_kinds.begin(), scene_kinds.end(), one.kind) == scene_kinds.end()) {
        fail(path, ": the kind of damage ", one.id, " is ", one.kind,
             "; it must be pothole, bump, crack, alligator or rut");
      }
      one.depth_m = damage.at("max_depth_m");
      one.area_m2 = damage.at("area_m2");
      one.volume_m3 = damage.at("volume_m3");
      one.mean_depth_m = one.volume_m3 / one.area_m2;
      scene.damages.push_back(one);
    }
  } catch (const nlohmann::json::exception& error) {
    fail(path, ": ", error.what());
  }
  return scene;
}

}  // namespace roadstereo::cli
