#include "evaluate/middlebury_scenes.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "core/max_disparities.hpp"
#include "mask_file.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/io/image_file.hpp"

namespace roadstereo::cli {
namespace {

namespace fs = std::filesystem;

bool is_scene(const fs::path& folder) {
  return fs::is_regular_file(folder / "im0.png");
}

/// Number of disparities of the scene, from "ndisp=" in calib.txt.
int read_ndisp(const std::string& path) {
  std::ifstream file(path);
  if (!file) fail("cannot read ", path);
  std::stringstream text;
  text << file.rdbuf();
  const std::string key = "ndisp=";
  const auto position = text.str().find(key);
  if (position == std::string::npos) fail(path, ": ndisp is missing; it must be between 1 and ", max_disparities);
  int disparities = 0;
  std::istringstream(text.str().substr(position + key.size())) >> disparities;
  if (disparities < 1 || disparities > max_disparities) {
    fail(path, ": ndisp is ", disparities, "; it must be between 1 and ", max_disparities);
  }
  return disparities;
}

}  // namespace

std::vector<std::string> find_middlebury_scenes(const std::string& folder) {
  if (!fs::is_directory(folder)) fail(folder, " is not a folder");
  if (is_scene(folder)) return {folder};
  std::vector<std::string> scenes;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (is_scene(entry.path())) scenes.push_back(entry.path().string());
  }
  if (scenes.empty()) fail(folder, ": neither the folder nor a subfolder contains im0.png of Middlebury v3");
  std::sort(scenes.begin(), scenes.end());
  return scenes;
}

MiddleburyScene read_middlebury_scene(const std::string& folder) {
  const fs::path root = fs::weakly_canonical(folder);
  MiddleburyScene scene;
  scene.name = root.filename().string();
  scene.pair = read_pair({(root / "im0.png").string(), (root / "im1.png").string(), {}});
  scene.truth = io::read_disparity((root / "disp0GT.pfm").string());
  constexpr int visible_in_both = 255;  // 128: in the left image only
  scene.visible = read_mask((root / "mask0nocc.png").string(), visible_in_both);
  scene.disparities = read_ndisp((root / "calib.txt").string());
  return scene;
}

}  // namespace roadstereo::cli
