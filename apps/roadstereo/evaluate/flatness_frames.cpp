#include "evaluate/flatness_frames.hpp"

#include <optional>

#include "evaluate/road_flatness.hpp"
#include "evaluate/roll_trials.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::cli {
namespace {

/// Throws Error unless mask and truth have one size.
void require_size(const Image<std::uint8_t>& mask, const Image<float>& truth, const std::string& path) {
  if (mask.width() == truth.width() && mask.height() == truth.height()) return;
  fail(path, " has ", mask.width(), "×", mask.height(), " pixels; it must have ", truth.width(), "×", truth.height(),
       " like the ground truth");
}

}  // namespace

Flatness measure_flatness(ImageView<const float> disparity, ImageView<const std::uint8_t> mask, int threads) {
  Flatness flatness;
  flatness.without_roll_px = transformed_deviation(disparity, mask, fit_without_roll(disparity, mask));
  for (std::size_t i = 0; i < roll_solvers().size(); ++i) {
    RollOptions options;
    options.solver = roll_solvers()[i].solver;
    const RollEstimate estimate = estimate_roll(disparity, mask, std::nullopt, 0, options, threads);
    flatness.with_roll_px[i] = transformed_deviation(disparity, mask, estimate.plane);
    flatness.roll_rad[i] = estimate.roll_rad;
  }
  return flatness;
}

FlatnessFrame measure_frame(const KittiFiles& files, const std::string& preset, const MethodSettings& methods) {
  const LabelledFrame frame = read_kitti_frame(files);
  if (!frame.road) fail(files.name, ": the frame has no road mask; --road-masks gives the folder of the masks");
  require_size(*frame.road, frame.truth, files.road);
  const Image<float> matched = run_method(preset, MethodTask{frame.pair}, methods);
  return {files.name, measure_flatness(frame.truth, *frame.road, methods.threads),
          measure_flatness(matched, *frame.road, methods.threads)};
}

}  // namespace roadstereo::cli
