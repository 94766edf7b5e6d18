#include "evaluate/kitti_frames.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <functional>

#include "core/require_size.hpp"
#include "evaluate/road_polygons.hpp"
#include "mask_file.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/io/image_file.hpp"

namespace roadstereo::cli {
namespace {

namespace fs = std::filesystem;

std::string require_file(const fs::path& path) {
  if (!fs::is_regular_file(path))
    fail(path.string(), ": the file is missing; every ground truth must have its stereo pair");
  return path.string();
}

std::string path_if_present(const fs::path& path) {
  return fs::is_regular_file(path) ? path.string() : "";
}

/// Intrinsics of the rectified cameras (P2) by the width of the rectified images, which differs between recording days.
std::optional<StereoCalibration> kitti_calibration(int width) {
  struct Day {
    int width;
    double focal_px, cx_px, cy_px;
  };
  constexpr std::array<Day, 5> days{{{1242, 721.54, 609.56, 172.85},
                                     {1241, 718.86, 607.19, 185.22},
                                     {1238, 718.34, 600.39, 181.51},
                                     {1226, 707.09, 601.89, 183.11},
                                     {1224, 707.05, 604.08, 180.51}}};
  for (const Day& day : days) {
    if (day.width == width) return StereoCalibration{day.focal_px, day.cx_px, day.cy_px, 0.5327, 0, 0, 0};
  }
  return std::nullopt;
}

/// Folders of a data set.
struct Layout {
  const char* left;
  const char* right;
  const char* truth;
  const char* calibration;
};
constexpr std::array layouts{Layout{"image_2", "image_3", "disp_noc_0", "calib_cam_to_cam"},
                             Layout{"colored_0", "colored_1", "disp_noc", "calib"},
                             Layout{"image_0", "image_1", "disp_noc", "calib"}};

Layout layout_of(const fs::path& root) {
  for (const Layout& layout : layouts) {
    if (fs::is_directory(root / layout.truth) && fs::is_directory(root / layout.left)) return layout;
  }
  for (const Layout& layout : layouts) {  // its images are missing
    if (fs::is_directory(root / layout.truth)) return layout;
  }
  fail(root.string(),
       ": the folder has neither disp_noc_0 nor disp_noc; it must have the layout of KITTI Stereo 2015 or 2012");
}

/// Frames without a mask or polygons stay without a road. Throws Error if `road_masks` is given and all do.
void add_roads(const fs::path& root, const std::string& road_masks, std::vector<KittiFiles>& frames) {
  if (fs::is_regular_file(road_masks)) {
    auto polygons = read_road_polygons(road_masks);
    for (KittiFiles& frame : frames) frame.polygons = std::move(polygons[frame.name]);
  } else {
    if (!road_masks.empty() && !fs::is_directory(road_masks)) {
      fail(road_masks, " is neither a folder of masks nor a JSON file of polygons");
    }
    const fs::path masks = road_masks.empty() ? root / "road" : fs::path(road_masks);
    for (KittiFiles& frame : frames) frame.road = path_if_present(masks / (frame.name + ".png"));
  }
  if (road_masks.empty() || std::any_of(frames.begin(), frames.end(), std::mem_fn(&KittiFiles::has_road))) return;
  fail(road_masks, " has the road of no frame; names must be those of the frames, such as ", frames.front().name);
}

}  // namespace

std::vector<KittiFiles> find_kitti_frames(const std::string& folder, const std::string& road_masks) {
  const fs::path root = folder;
  const Layout layout = layout_of(root);
  const fs::path truths = root / layout.truth;
  std::vector<KittiFiles> frames;
  for (const auto& entry : fs::directory_iterator(truths)) {
    const fs::path file = entry.path().filename();
    if (file.extension() != ".png") continue;
    const std::string name = file.stem().string();
    const std::string number = name.substr(0, name.find('_'));
    frames.push_back({name, require_file(root / layout.left / file), require_file(root / layout.right / file),
                      entry.path().string(), path_if_present(root / layout.calibration / (number + ".txt")), ""});
  }
  if (frames.empty()) fail(truths.string(), ": the folder contains no PNG file");
  std::sort(frames.begin(), frames.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
  add_roads(root, road_masks, frames);
  return frames;
}

LabelledFrame read_kitti_frame(const KittiFiles& files) {
  LabelledFrame frame;
  PairFiles pair{files.left, files.right, {}};
  if (!files.calibration.empty()) pair.calibration.push_back(files.calibration);
  frame.pair = read_pair(pair);
  if (!frame.pair.calibration) frame.pair.calibration = kitti_calibration(frame.pair.left.width);
  const ImageSize size{frame.pair.left.width, frame.pair.left.height};
  frame.truth = io::read_disparity(files.truth);
  require_same_size(files.truth.c_str(), map_size(frame.truth), "the left image", size);
  constexpr int usual_disparities = 128;
  frame.disparities = disparities_of(frame.truth, usual_disparities);
  if (!files.polygons.empty()) {
    frame.road = polygon_mask(files.polygons, size.width, size.height);
  } else if (!files.road.empty()) {
    frame.road = read_mask(files.road);
    require_same_size(files.road.c_str(), map_size(*frame.road), "the left image", size);
  }
  return frame;
}

}  // namespace roadstereo::cli
