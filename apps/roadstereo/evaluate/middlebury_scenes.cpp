#include "evaluate/middlebury_scenes.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "evaluate/mask_file.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/io/image_file.hpp"

namespace roadstereo::cli {
namespace {

namespace fs = std::filesystem;

bool is_scene(const fs::path& folder) {
  return fs::is_regular_file(folder / "im0.png");
}

/// The figure behind "ndisp=": how many disparities the scene needs.
int read_ndisp(const std::string& path) {
  std::ifstream file(path);
  if (!file) fail("cannot read ", path);
  std::stringstream text;
  text << file.rdbuf();
  constexpr int most = 1024;
  const std::string key = "ndisp=";
  const auto at = text.str().find(key);
  int disparities = 0;
  if (at != std::string::npos) std::istringstream(text.str().substr(at + key.size())) >> disparities;
  if (disparities < 1 || disparities > most) fail(path, " must say ndisp= with a number from 1 to ", most);
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
  if (scenes.empty()) fail("neither ", folder, " nor a folder in it has an im0.png of Middlebury v3");
  std::sort(scenes.begin(), scenes.end());
  return scenes;
}

MiddleburyScene read_middlebury_scene(const std::string& folder) {
  const fs::path root = fs::weakly_canonical(folder);
  MiddleburyScene scene;
  scene.name = root.filename().string();
  scene.pair = read_pair({(root / "im0.png").string(), (root / "im1.png").string(), {}});
  scene.truth = io::read_disparity((root / "disp0GT.pfm").string());
  constexpr int seen_by_both = 255;  // 128: by the left camera alone
  scene.seen_twice = read_mask((root / "mask0nocc.png").string(), seen_by_both);
  scene.disparities = read_ndisp((root / "calib.txt").string());
  return scene;
}

}  // namespace roadstereo::cli
