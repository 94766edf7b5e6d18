#include "evaluate/scene_folders.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

#include "roadstereo/error.hpp"
#include "roadstereo/io/image_file.hpp"

namespace roadstereo::cli {
namespace {

namespace fs = std::filesystem;

/// 8-bit grey image of one size with `like`.
Frame read_labels(const fs::path& path, const Frame& like) {
  Frame labels = io::read_frame(path.string());
  if (labels.sample != SampleType::u8 || labels.order != ChannelOrder::grey) fail(path.string(), " is not 8-bit grey");
  if (labels.width != like.width || labels.height != like.height) {
    fail(path.string(), " has ", labels.width, "×", labels.height, " pixels; it must have ", like.width, "×",
         like.height, " like the pair");
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
  frame.truth = io::read_disparity((folder / "disparity.tiff").string());
  frame.disparities = disparities_of(frame.truth, 0);
  const Frame region = read_labels(folder / "region.png", frame.pair.left);
  const Frame seen = read_labels(folder / "occ.png", frame.pair.left);
  frame.road.emplace(region.width, region.height, std::uint8_t{0});
  for (std::size_t i = 0; i < region.bytes.size(); ++i) {
    const bool on_road = region.bytes[i] == road || region.bytes[i] == damage;
    frame.road->row(0)[i] = on_road && seen.bytes[i] == seen_by_both ? 255 : 0;
  }
  return frame;
}

}  // namespace roadstereo::cli
