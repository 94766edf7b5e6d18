#include "flatness_frames.hpp"

#include <algorithm>
#include <optional>

#include "mask_file.hpp"
#include "road_flatness.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/io/image_file.hpp"
#include "roll_trials.hpp"

namespace roadstereo::cli {
namespace {

/// The mask belongs to the map: `path` names the file that is of another size.
void require_size(const Image<std::uint8_t>& mask, const Image<float>& disparity, const std::filesystem::path& path) {
  if (mask.width() == disparity.width() && mask.height() == disparity.height()) return;
  fail(path.string(), " has ", mask.width(), "×", mask.height(), " pixels and the disparity map ", disparity.width(),
       "×", disparity.height(), "; they must be equal");
}

}  // namespace

std::vector<std::string> flatness_frames(const FlatnessFolders& folders) {
  const std::filesystem::path truth = folders.data / "disp_noc_0";
  if (!std::filesystem::is_directory(truth)) {
    fail(folders.data.string(), " has no folder disp_noc_0; flatness takes a folder like KITTI Stereo 2015's training");
  }
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(truth)) {
    if (entry.path().extension() == ".png") names.push_back(entry.path().filename().string());
  }
  if (names.empty()) fail(truth.string(), " has no PNG files; flatness needs ground truth disparities");
  std::sort(names.begin(), names.end());
  return names;
}

Flatness measure_flatness(ImageView<const float> disparity, ImageView<const std::uint8_t> mask, int threads) {
  Flatness flatness;
  flatness.without_roll_px = transformed_deviation(disparity, mask, fit_without_roll(disparity, mask));
  for (std::size_t i = 0; i < roll_solvers().size(); ++i) {
    RoadGeometryOptions options;
    options.solver = roll_solvers()[i].solver;
    const RoadGeometry geometry = fit_road_geometry(disparity, mask, std::nullopt, 0, options, threads);
    flatness.with_roll_px[i] = transformed_deviation(disparity, mask, geometry.plane);
    flatness.roll_rad[i] = geometry.roll_rad;
  }
  return flatness;
}

FlatnessFrame measure_frame(const FlatnessFolders& folders, const std::string& name, const PipelineOptions& options) {
  const Image<float> truth = io::read_disparity((folders.data / "disp_noc_0" / name).string());
  const std::filesystem::path mask_file = folders.road_masks / name;
  const Image<std::uint8_t> mask = read_mask(mask_file.string());
  require_size(mask, truth, mask_file);
  const Frame left = io::read_frame((folders.data / "image_2" / name).string());
  const Frame right = io::read_frame((folders.data / "image_3" / name).string());
  if (left.width != truth.width() || left.height != truth.height()) {
    fail(name, ": the image has ", left.width, "×", left.height, " pixels and the ground truth ", truth.width(), "×",
         truth.height(), "; they must be equal");
  }
  Pipeline pipeline(options);
  const FrameResult& result = pipeline.process(left.view(), right.view());
  return {name, measure_flatness(truth, mask, options.threads),
          measure_flatness(result.disparity, mask, options.threads)};
}

}  // namespace roadstereo::cli
