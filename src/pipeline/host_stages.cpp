#include "pipeline/host_stages.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/parallel.hpp"
#include "pipeline/pair_checks.hpp"
#include "road/shift_terms_of.hpp"
#include "roadstereo/device.hpp"
#include "roadstereo/error.hpp"
#include "stereo/coarse/coarse_search.hpp"
#include "stereo/coarse/road_plausibility.hpp"
#include "stereo/window.hpp"

namespace roadstereo {
namespace {

bool shows_something(const GreyImage& image) {
  const std::int16_t first = image(0, 0);
  for (int v = 0; v < image.height(); ++v) {
    const std::int16_t* row = image.row(v);
    if (std::any_of(row, row + image.width(), [first](std::int16_t value) { return value != first; })) return true;
  }
  return false;
}

double valid_share(const Image<float>& map) {
  std::size_t valid = 0;
  for (int v = 0; v < map.height(); ++v) {
    const float* row = map.row(v);
    for (int u = 0; u < map.width(); ++u) valid += std::isnan(row[u]) ? 0U : 1U;
  }
  return static_cast<double>(valid) / static_cast<double>(map.pixels());
}

class HostStages final : public FrameStages {
 public:
  HostStages(const PipelineOptions& options, const std::optional<StereoCalibration>& calibration)
      : options_(options),
        calibration_(calibration),
        threads_(resolve_threads(options.threads)),
        support_(effective_samples(options.matcher)),
        engine_(make_engine(options.engine, options.threads)) {
    if (options.narrow_search || options.matcher.prior_weight > 0) {
      coarse_search_.emplace(options.coarse_search, options.threads);
    }
  }

  void prepare(const FrameView& left, const FrameView& right, FrameResult& result) override {
    to_grey(left, options_.white_level, result.grey);
    to_grey(right, options_.white_level, right_);
    PairContents contents;
    contents.left = {shows_something(result.grey), result.grey(0, 0)};
    contents.right = {shows_something(right_), right_(0, 0)};
    contents.equal = result.grey == right_;
    require_pair(contents);
  }

  GreyPair grey(FrameResult& result) override { return {result.grey, right_}; }

  RoadModelEstimate verify_road(const TrackedRoad& previous, const FrameResult& result) override {
    return verify_road_model(result.grey, right_, previous, calibration_, options_.road_model, threads_);
  }

  void transform_perspective(const FrameResult& result) override {
    transform_target(right_, result.shift, threads_, transformed_target_, first_column_);
  }

  void search_coarsely(const FrameResult& result) override {
    match_input_ = {result.grey, transformed_target_, first_column_.data(), result.shift.disparities};
    if (!coarse_search_) return;
    const auto road = [shift = shift_terms(result.shift)](double u, double v) {
      return shifted_road(shift, u, v, std::numeric_limits<double>::quiet_NaN());
    };
    if (!coarse_search_->find(match_input_, road)) return;
    if (options_.narrow_search) match_input_.ranges = coarse_search_->ranges();
    match_input_.prior = &coarse_search_->prior();
  }

  void match(const MatcherOptions& options, const FrameResult&) override {
    engine_->match(match_input_, options, maps_);
  }

  void refine(FrameResult& result) override {
    add_shift(maps_.disparity, result.shift, threads_, shifted_);
    refine_disparities(shifted_, maps_.variance, result.shift.road, support_, options_.refinement, threads_,
                       result.disparity, result.sigma);
  }

  bool fit_geometry(const std::optional<DisparityPlane>& prior, double initial_roll_rad, double min_share,
                    FrameResult& result) override {
    result.valid_share = valid_share(result.disparity);
    if (result.valid_share < min_share) return false;
    result.geometry = estimate_roll(result.disparity, std::nullopt, prior, initial_roll_rad, options_.roll, threads_);
    return true;
  }

  void transform(FrameResult& result) override {
    result.delta_t = transform_disparity(result.disparity, result.geometry, result.shift.delta_p, options_.roll,
                                         threads_, result.transformed);
    result.spread = measure_residuals(result.transformed, result.delta_t, threads_);
  }

  void invalidate_transformed(FrameResult& result) override {
    result.transformed.assign(result.grey.width(), result.grey.height(), std::numeric_limits<float>::quiet_NaN());
  }

  void deliver(FrameResult&) override {}

  void set_device_options(const DeviceOptions&) override { fail_without_device(); }
  DeviceMaps device_maps() const override { fail_without_device(); }

 private:
  [[noreturn]] static void fail_without_device() {
    fail("only a pipeline with the engine cuda keeps its maps on a device");
  }

  PipelineOptions options_;
  std::optional<StereoCalibration> calibration_;
  int threads_;
  double support_;  ///< pixels that one disparity rests on
  std::unique_ptr<StereoEngine> engine_;
  std::optional<CoarseSearch> coarse_search_;

  // Scratch memory.
  GreyImage right_, transformed_target_;
  std::vector<int> first_column_;
  MatchInput match_input_;
  MatchMaps maps_;
  Image<float> shifted_;  ///< disparities before they are refined
};

}  // namespace

std::unique_ptr<FrameStages> make_host_stages(const PipelineOptions& options,
                                              const std::optional<StereoCalibration>& calibration) {
  return std::make_unique<HostStages>(options, calibration);
}

}  // namespace roadstereo
