#include "evaluation/peer_programs.hpp"

#include <sys/wait.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iomanip>
#include <opencv2/imgcodecs.hpp>
#include <sstream>

#include "evaluation/peer_maps.hpp"
#include "evaluation/peer_scripts.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/rigid_transform.hpp"

namespace roadstereo::io {
namespace fs = std::filesystem;
namespace {

constexpr double largest_depth = 65535;  // of 16 bits

std::string picture_name(int frame) {
  std::ostringstream name;
  name << std::setw(6) << std::setfill('0') << frame << ".png";
  return name.str();
}

/// Runs a command of the shell, whose output goes to a file. Throws Error with the last line of it.
void run_command(const std::string& command, const char* name, const fs::path& log) {
  const int status = std::system(("( " + command + " ) >'" + log.string() + "' 2>&1").c_str());
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
  std::ifstream stream(log);
  std::string line, last;
  while (std::getline(stream, line)) last = line.empty() ? last : line;
  fail(name, " failed: ", last);
}

void require_program(const std::string& test, const char* reason) {
  if (std::system(("( " + test + " ) >/dev/null 2>&1").c_str()) != 0) fail(reason);
}

/// Motion of a unit quaternion (w, x, y, z) and a translation.
RigidTransform motion_of(const std::array<double, 4>& q, const std::array<double, 3>& t) {
  const auto [w, x, y, z] = q;
  return {1 - 2 * (y * y + z * z), 2 * (x * y - z * w),     2 * (x * z + y * w),     t[0],
          2 * (x * y + z * w),     1 - 2 * (x * x + z * z), 2 * (y * z - x * w),     t[1],
          2 * (x * z - y * w),     2 * (y * z + x * w),     1 - 2 * (x * x + y * y), t[2]};
}

/// images.txt of COLMAP: of each image a line with its pose, world to camera, and a line with its points.
PeerPoses read_images(const fs::path& file, int frames) {
  PeerPoses poses;
  poses.camera_to_world.resize(static_cast<std::size_t>(frames));
  std::ifstream stream(file);
  if (!stream) fail(file.string(), ": cannot be read");
  std::string line;
  while (std::getline(stream, line)) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream words(line);
    int id = 0, camera = 0;
    std::array<double, 4> q{};
    std::array<double, 3> t{};
    std::string name;
    words >> id;
    for (double& value : q) words >> value;
    for (double& value : t) words >> value;
    words >> camera >> name;
    const int frame = std::atoi(name.c_str());
    if (!words || frame < 0 || frame >= frames) fail(file.string(), ": this is no line of an image: ", line);
    poses.camera_to_world[static_cast<std::size_t>(frame)] = inverse(motion_of(q, t));
    std::getline(stream, line);
  }
  return poses;
}

/// The folder of the model with the most images: COLMAP makes several where it cannot join them.
fs::path largest_model(const fs::path& sparse) {
  fs::path best;
  std::uintmax_t largest = 0;
  for (const fs::directory_entry& model : fs::directory_iterator(sparse)) {
    const std::uintmax_t size = fs::file_size(model.path() / "images.bin");
    if (size <= largest) continue;
    largest = size;
    best = model.path();
  }
  if (best.empty()) fail("colmap made no model");
  return best;
}

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace

PeerFrames::PeerFrames(fs::path folder, const StereoCalibration& calibration)
    : folder_(std::move(folder)), calibration_(calibration) {
  fs::create_directories(folder_ / "images");
  fs::create_directories(folder_ / "depths");
}

double PeerFrames::max_depth_m() const {
  return calibration_.focal_px * calibration_.baseline_m / min_peer_disparity_px;
}

void PeerFrames::add(const GreyImage& grey, const Image<float>& disparity) {
  const cv::Mat depths = depths_m(disparity, calibration_);
  cv::Mat steps(depths.size(), CV_16U);
  for (int v = 0; v < depths.rows; ++v) {
    for (int u = 0; u < depths.cols; ++u) {
      const double share = depths.at<float>(v, u) / max_depth_m();
      steps.at<std::uint16_t>(v, u) =
          std::isnan(share) ? std::uint16_t{0} : cv::saturate_cast<std::uint16_t>(largest_depth * share);
    }
  }
  const std::string name = picture_name(frames_++);
  if (!cv::imwrite((folder_ / "images" / name).string(), grey_bytes(grey)) ||
      !cv::imwrite((folder_ / "depths" / name).string(), steps)) {
    fail<SystemError>("cannot write ", (folder_ / "images" / name).string());
  }
}

PeerPoses run_colmap(const PeerFrames& frames) {
  require_program("command -v colmap", "colmap is not in PATH (Debian's package colmap)");
  const StereoCalibration& c = frames.calibration();
  const std::string at = "'" + frames.folder().string() + "/";
  const fs::path log = frames.folder() / "colmap.log";
  std::ostringstream camera;
  camera << std::setprecision(12) << c.focal_px << "," << c.cx_px + 0.5 << "," << c.cy_px + 0.5;  // pixels begin at 0
  const std::string colmap = "QT_QPA_PLATFORM=offscreen colmap ", data = " --database_path " + at + "database.db'";
  const std::string images = " --image_path " + at + "images'";
  const auto begin = std::chrono::steady_clock::now();
  run_command(colmap + "feature_extractor" + data + images +
                  " --ImageReader.single_camera 1 --ImageReader.camera_model SIMPLE_PINHOLE"
                  " --ImageReader.camera_params " +
                  camera.str() + " --SiftExtraction.use_gpu 0",
              "colmap", log);
  run_command(colmap + "sequential_matcher" + data + " --SiftMatching.use_gpu 0", "colmap", log);
  fs::create_directories(frames.folder() / "sparse");
  run_command(colmap + "mapper" + data + images + " --output_path " + at +
                  "sparse' --Mapper.ba_refine_focal_length 0 --Mapper.ba_refine_extra_params 0",
              "colmap", log);
  const double seconds = seconds_since(begin);
  run_command(colmap + "model_converter --output_type TXT --input_path '" +
                  largest_model(frames.folder() / "sparse").string() + "' --output_path " + at + "'",
              "colmap", log);
  PeerPoses poses = read_images(frames.folder() / "images.txt", frames.frames());
  poses.seconds = seconds;
  return poses;
}

PeerPoses run_open3d(const PeerFrames& frames) {
  require_program("python3 -c 'import open3d'", "python3 has no open3d (Debian's package python3-open3d)");
  const fs::path script = frames.folder() / "odometry.py", log = frames.folder() / "open3d.txt";
  std::ofstream(script) << peer_scripts::open3d_odometry;
  const StereoCalibration& c = frames.calibration();
  std::ostringstream command;
  command << std::setprecision(12) << "python3 '" << script.string() << "' '" << frames.folder().string() << "' "
          << frames.frames() << " " << c.focal_px << " " << c.cx_px << " " << c.cy_px << " " << frames.max_depth_m();
  run_command(command.str(), "open3d", log);
  PeerPoses poses;
  RigidTransform pose{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
  poses.camera_to_world.emplace_back(pose);
  std::ifstream stream(log);
  std::string line;
  while (std::getline(stream, line) && static_cast<int>(poses.camera_to_world.size()) < frames.frames()) {
    std::istringstream words(line);
    std::array<std::string, 12> text;
    for (std::string& word : text) words >> word;
    double seconds = 0;
    if (!(words >> seconds)) continue;  // what Open3D says besides
    poses.seconds += seconds;
    if (text[0] == "nan") {
      poses.camera_to_world.emplace_back();
      continue;
    }
    RigidTransform motion{};
    std::transform(text.begin(), text.end(), motion.begin(),
                   [](const std::string& word) { return std::atof(word.c_str()); });
    pose = compose(pose, inverse(motion));
    poses.camera_to_world.emplace_back(pose);
  }
  if (static_cast<int>(poses.camera_to_world.size()) != frames.frames()) {
    fail("open3d gave ", poses.camera_to_world.size() - 1, " motions of ", frames.frames(), " frames");
  }
  return poses;
}

}  // namespace roadstereo::io
