#include "evaluate/scan_frames.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "core/require_size.hpp"
#include "evaluation/ply_read.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/io/point_cloud.hpp"

namespace roadstereo::cli {
namespace {

namespace fs = std::filesystem;

/// Files of a folder with that prefix and suffix, sorted.
std::vector<fs::path> files_in(const fs::path& folder, const std::string& prefix, const std::string& suffix) {
  if (!fs::is_directory(folder)) fail(folder.string(), " is not a folder");
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(prefix) && name.ends_with(suffix)) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// Name of the pothole: "p1" for "p1_05".
std::string pothole_of(const std::string& name) {
  return name.substr(0, name.find('_'));
}

std::string find_scan(const fs::path& root, const std::string& pothole) {
  const auto scans = files_in(root / "scan", pothole + "_", ".ply");
  if (scans.empty()) fail((root / "scan").string(), ": the folder contains no scan ", pothole, "_….ply");
  return scans.front().string();
}

std::string find_calibration(const fs::path& root, const std::string& pothole) {
  const std::string prefix = "calibration_p";
  for (const fs::path& path : files_in(root, prefix, ".yaml")) {
    const std::string potholes = path.stem().string().substr(prefix.size());
    if (pothole.size() == 2 && potholes.find(pothole[1]) != std::string::npos) return path.string();
  }
  const fs::path of_all = root / "calibration.yaml";
  if (fs::is_regular_file(of_all)) return of_all.string();
  fail(root.string(), ": the folder contains no calibration_p….yaml for ", pothole, ", and no calibration.yaml");
}

std::string require_file(const fs::path& path) {
  if (!fs::is_regular_file(path)) fail("cannot read ", path.string());
  return path.string();
}

}  // namespace

std::vector<LabelledFiles> find_labelled_pairs(const std::string& folder) {
  const fs::path root = folder;
  std::vector<LabelledFiles> pairs;
  for (const fs::path& left : files_in(root / "left", "p", ".png")) {
    const std::string name = left.stem().string(), file = left.filename().string();
    pairs.push_back({name,
                     {left.string(), require_file(root / "right" / file), {find_calibration(root, pothole_of(name))}},
                     require_file(root / "label" / file)});
  }
  if (pairs.empty()) fail((root / "left").string(), ": the folder contains no image pM_NN.png");
  return pairs;
}

std::vector<ScanFiles> find_scan_frames(const std::string& folder) {
  std::vector<ScanFiles> frames;
  for (const LabelledFiles& pair : find_labelled_pairs(folder)) {
    frames.push_back({pair, find_scan(folder, pothole_of(pair.name))});
  }
  return frames;
}

Points read_points(const std::string& path, double to_mm) {
  const PointCloud cloud = io::read_ply(path);
  Points points;
  points.reserve(cloud.points.size());
  for (const auto& [x, y, z] : cloud.points) points.emplace_back(to_mm * x, to_mm * y, to_mm * z);
  return points;
}

LabelledPoints labelled_points(ImageView<const float> disparity, ImageView<const std::uint8_t> label,
                               const StereoCalibration& calibration) {
  require_same_size("the label", map_size(label), "the image", map_size(disparity));
  constexpr double to_mm = 1000;
  LabelledPoints found;
  for (int v = 0; v < label.height(); ++v) {
    for (int u = 0; u < label.width(); ++u) {
      if (label(u, v) == 0) continue;
      ++found.labelled;
      const double d = disparity(u, v);
      if (!std::isfinite(d) || d + calibration.disparity_offset_px <= 0) continue;
      const auto [x, y, z] = calibration.point_m(u, v, d);
      found.points.emplace_back(to_mm * x, to_mm * y, to_mm * z);
      found.pixels.push_back({u, v});
    }
  }
  if (found.labelled == 0) fail("the label has no labelled pixel; it must have at least one");
  return found;
}

}  // namespace roadstereo::cli
