#include "evaluate/flatness_frames.hpp"

#include <optional>

#include "evaluate/road_flatness.hpp"
#include "evaluate/roll_trials.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::cli {
namespace {

/// σ_d of the road inside the mask.
Flatness measure_flatness(ImageView<const float> disparity, ImageView<const std::uint8_t> mask, int threads) {
  Flatness flatness;
  flatness.without_roll_px = transformed_deviation(disparity, mask, fit_without_roll(disparity, mask));
  for (std::size_t i = 0; i < roll_solvers().size(); ++i) {
    RollOptions options;
    options.solver = roll_solvers()[i].solver;
    const RollEstimate estimate = estimate_roll(disparity, mask, std::nullopt, 0, options, threads);
    flatness.with_roll_px[i] = transformed_deviation(disparity, mask, estimate.plane);
  }
  return flatness;
}

}  // namespace

FlatnessFrame measure_frame(const KittiFiles& files, const std::string& preset, const MethodSettings& methods) {
  const LabelledFrame frame = read_kitti_frame(files);
  if (!frame.road) fail(files.name, ": the frame has no road mask; --road-masks gives the folder of the masks");
  const Image<float> matched = run_method(preset, MethodTask{frame.pair}, methods);
  return {files.name, measure_flatness(frame.truth, *frame.road, methods.threads),
          measure_flatness(matched, *frame.road, methods.threads)};
}

}  // namespace roadstereo::cli
