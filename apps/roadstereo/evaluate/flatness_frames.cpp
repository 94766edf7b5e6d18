#include "flatness_frames.hpp"

#include <algorithm>
#include <optional>

#include "road_flatness.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/io/image_file.hpp"
#include "roll_trials.hpp"

namespace roadstereo::cli {
namespace {

/// 255 where the mask's first channel is not black.
Image<std::uint8_t> read_mask(const std::filesystem::path& path, int width, int height) {
  const Frame frame = io::read_frame(path.string());
  if (frame.width != width || frame.height != height) {
    fail(path.string(), " has ", frame.width, "×", frame.height, " pixels and the disparity map ", width, "×", height,
         "; they must be equal");
  }
  if (frame.sample != SampleType::u8) fail(path.string(), " has 16 bits per sample; a mask must have 8");
  const auto channels = static_cast<std::size_t>(channel_count(frame.order));
  Image<std::uint8_t> mask(width, height);
  for (std::size_t pixel = 0; pixel < mask.pixels(); ++pixel) {
    mask.row(0)[pixel] = frame.bytes[pixel * channels] != 0 ? 255 : 0;
  }
  return mask;
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
  const Image<std::uint8_t> mask = read_mask(folders.road_masks / name, truth.width(), truth.height());
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
