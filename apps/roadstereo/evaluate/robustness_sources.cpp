#include "evaluate/robustness_sources.hpp"

#include <algorithm>
#include <cstdint>
#include <filesystem>

#include "evaluate/kitti_frames.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/io/frame_source.hpp"
#include "roadstereo/io/image_file.hpp"

namespace roadstereo::cli {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> subfolders(const fs::path& folder) {
  std::vector<fs::path> found;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.is_directory()) found.push_back(entry.path());
  }
  std::sort(found.begin(), found.end());
  return found;
}

bool has_files(const fs::path& folder, std::initializer_list<const char*> names) {
  return std::all_of(names.begin(), names.end(), [&](const char* name) { return fs::exists(folder / name); });
}

bool is_scene(const fs::path& folder) {
  return has_files(folder, {"left.png", "right.png", "disparity.tiff", "occ.png", "region.png"});
}

std::string name_of(const fs::path& folder) {
  return (folder.parent_path().filename() / folder.filename()).string();
}

LabelledSource kitti_source(const fs::path& folder) {
  LabelledSource source{name_of(folder), {}, {}};
  const std::vector<KittiFiles> files = find_kitti_frames(folder.string(), "");
  for (const KittiFiles& of_frame : files) source.frames.push_back(of_frame.name);
  source.read_labelled = [files](std::size_t frame) {
    if (files[frame].road.empty()) fail(files[frame].truth, ": the frame has no road mask in road/");
    return read_kitti_frame(files[frame]);
  };
  return source;
}

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

/// The road of a scene: road and damage that both cameras see.
LabelledFrame read_scene(const fs::path& folder) {
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

LabelledSource scene_source(const fs::path& folder, const std::vector<fs::path>& scenes) {
  LabelledSource source{name_of(folder), {}, [scenes](std::size_t frame) { return read_scene(scenes[frame]); }};
  for (const fs::path& scene : scenes) source.frames.push_back(scene.filename().string());
  return source;
}

void find_sources(const fs::path& folder, RobustnessSources& sources) {
  if (fs::is_directory(folder / "disp_noc_0") && fs::is_directory(folder / "road")) {
    sources.labelled.push_back(kitti_source(folder));
    return;
  }
  if (is_scene(folder)) {
    sources.labelled.push_back(scene_source(folder.parent_path(), {folder}));
    return;
  }
  if (fs::exists(folder / "calibration.yaml") && io::is_recording(folder.string())) {
    sources.drives.push_back({name_of(folder), folder.string(), {(folder / "calibration.yaml").string()}});
    return;
  }
  std::vector<fs::path> scenes, others;
  for (const fs::path& inside : subfolders(folder)) (is_scene(inside) ? scenes : others).push_back(inside);
  if (!scenes.empty()) sources.labelled.push_back(scene_source(folder, scenes));
  for (const fs::path& inside : others) find_sources(inside, sources);
}

}  // namespace

RobustnessSources find_robustness_sources(const std::vector<std::string>& folders) {
  RobustnessSources sources;
  for (const std::string& folder : folders) {
    if (!fs::is_directory(folder)) fail(folder, " is not a folder");
    const std::size_t before = sources.labelled.size() + sources.drives.size();
    find_sources(fs::canonical(folder), sources);
    if (sources.labelled.size() + sources.drives.size() > before) continue;
    fail(folder, ": there are no labelled pairs and no drive in this folder");
  }
  return sources;
}

}  // namespace roadstereo::cli
