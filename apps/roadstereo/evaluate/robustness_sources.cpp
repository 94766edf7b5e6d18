#include "evaluate/robustness_sources.hpp"

#include <algorithm>
#include <filesystem>

#include "evaluate/kitti_frames.hpp"
#include "evaluate/scene_folders.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/io/frame_source.hpp"

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

LabelledSource scene_source(const fs::path& folder, const std::vector<fs::path>& scenes) {
  LabelledSource source{name_of(folder), {}, [scenes](std::size_t frame) { return read_scene_folder(scenes[frame]); }};
  for (const fs::path& scene : scenes) source.frames.push_back(scene.filename().string());
  return source;
}

void find_sources(const fs::path& folder, RobustnessSources& sources) {
  if (fs::is_directory(folder / "disp_noc_0") && fs::is_directory(folder / "road")) {
    sources.labelled.push_back(kitti_source(folder));
    return;
  }
  if (is_scene_folder(folder)) {
    sources.labelled.push_back(scene_source(folder.parent_path(), {folder}));
    return;
  }
  if (fs::exists(folder / "calibration.yaml") && io::is_recording(folder.string())) {
    sources.drives.push_back({name_of(folder), folder.string(), {(folder / "calibration.yaml").string()}});
    return;
  }
  const std::vector<fs::path> scenes = scene_folders(folder);
  if (!scenes.empty()) sources.labelled.push_back(scene_source(folder, scenes));
  for (const fs::path& inside : subfolders(folder)) {
    if (!is_scene_folder(inside)) find_sources(inside, sources);
  }
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
