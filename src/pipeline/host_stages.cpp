#include "pipeline/host_stages.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "core/deblocking.hpp"
#include "core/gaussian_smoothing.hpp"
#include "core/grey_weights.hpp"
#include "core/parallel.hpp"
#include "pipeline/pair_checks.hpp"
#include "pipeline/support_samples.hpp"
#include "road/lucas_kanade/alignment_maps.hpp"
#include "road/refinement/refinement_maps.hpp"
#include "road/rig_bias_field.hpp"
#include "road/roll_assessment.hpp"
#include "road/row_shift.hpp"
#include "roadstereo/device.hpp"
#include "roadstereo/error.hpp"
#include "stereo/coarse/coarse_search.hpp"
#include "stereo/window.hpp"

namespace roadstereo {
namespace {

bool has_contrast(const GreyImage& image) {
  const std::int16_t first = image(0, 0);
  for (int v = 0; v < image.height(); ++v) {
    const std::int16_t* row = image.row(v);
    if (std::any_of(row, row + image.width(), [first](std::int16_t value) { return value != first; })) return true;
  }
  return false;
}

double valid_share(ImageView<const float> map) {
  double valid = 0;
  for (int v = 0; v < map.height(); ++v) {
    const float* row = map.row(v);
    int of_row = 0;
    for (int u = 0; u < map.width(); ++u) of_row += std::isnan(row[u]) ? 0 : 1;
    valid += of_row;
  }
  return valid / static_cast<double>(map.pixels());
}

class HostStages final : public FrameStages {
 public:
  HostStages(const PipelineOptions& options, const std::optional<StereoCalibration>& calibration)
      : options_(options),
        samples_(options.matcher),
        calibration_(calibration),
        threads_(resolve_threads(options.threads)),
        engine_(make_engine(options.engine, options.threads)),
        scene_search_(options.coarse_search, options.threads) {
    if (options.narrow_search || options.matcher.prior_weight > 0) {
      coarse_search_.emplace(options.coarse_search, options.threads);
    }
  }

  GreyPair convert_to_grey(const FrameView& left, const FrameView& right, double white_level) override {
    for (const FrameView* frame : {&left, &right}) grey_weights(*frame, white_level);  // left is named first
    PairContents contents;
    parallel_for(2, threads_, [&](int side, int) {
      GreyImage& grey = side == 0 ? left_ : right_;
      to_grey(side == 0 ? left : right, white_level, grey);
      (side == 0 ? contents.left : contents.right) = {has_contrast(grey), grey(0, 0)};
    });
    contents.equal = left_ == right_;
    require_pair(contents);
    parallel_for(2, threads_, [&](int side, int) { remove_block_steps(side); });
    return {left_, right_};
  }

  GreyPair on_host(const GreyPair& pair) override { return pair; }

  GreyPair smooth(const GreyPair&, double variance_px2) override {
    GreyImage& sharper = variance_px2 > 0 ? left_ : right_;
    transformed_target_.resize(sharper.width(), sharper.height());
    smooth_image(smoothing_kernel(std::abs(variance_px2)), threads_, sharper.view(), transformed_target_.view());
    return {left_, right_};
  }

  GreyPair undo_misalignment(const GreyPair& pair, const Misalignment& misalignment) override {
    transform_target(pair.right, without_road(misalignment), threads_, transformed_target_, first_column_);
    return {pair.left, transformed_target_};
  }

  RoadModelEstimate verify_road_model(const GreyPair& pair, const TrackedRoad& previous) override {
    return roadstereo::verify_road_model(pair.left, pair.right, previous, calibration_, options_.road_model, threads_,
                                         pair.mask);
  }

  MatchInput transform_perspective(const GreyPair& pair, const PerspectiveShift& shift) override {
    transform_target(pair.right, shift, threads_, transformed_target_, first_column_);
    return {pair.left, transformed_target_, first_column_.data(), shift.disparities, {}, {}};
  }

  MatchInput search_coarsely(const MatchInput& pair, const PerspectiveShift& shift,
                             const CoarseSearchOptions& options) override {
    MatchInput input = pair;
    if (!coarse_search_) return input;
    coarse_search_->set_options(options);
    if (!coarse_search_->find(pair, shift)) return input;
    if (options_.narrow_search && coarse_search_->ranges() != nullptr) input.ranges = coarse_search_->ranges()->views();
    input.prior = coarse_search_->prior().view();
    return input;
  }

  DisparityPriorView search_scene(const MatchInput& pair, const PerspectiveShift& shift,
                                  const CoarseSearchOptions& options) override {
    scene_search_.set_options(options);
    return scene_search_.find_prior(pair, shift) ? scene_search_.prior().view() : DisparityPriorView{};
  }

  ResidualMaps match(const MatchInput& input, const MatcherOptions& options) override {
    engine_->match(input, options, matched_);
    return {matched_.disparity, matched_.variance, samples_.of(options), step_of(matched_, options)};
  }

  DisparityMaps restore_disparity(const ResidualMaps& residual, const PerspectiveShift& shift) override {
    roadstereo::restore_disparity(residual.disparity, shift, residual.pixel_step, threads_, restored_);
    return {restored_, residual.variance, residual.samples, residual.pixel_step};
  }

  RefinedMaps refine(const DisparityMaps& maps, const DisparityPlane& road) override {
    // Nothing else needs these two maps now.
    const RefinementMaps between{matched_.disparity, transformed_};
    const bool whole = maps.pixel_step == 1;
    Image<float>&refined = whole ? disparity_ : refined_, &sigma = whole ? sigma_ : refined_sigma_;
    refine_disparities(maps.disparity, maps.variance, maps.pixel_step, road, maps.samples, options_.refinement,
                       threads_, between, refined, sigma);
    return {refined, sigma, maps.pixel_step};
  }

  InterpolatedMaps interpolate(const RefinedMaps& maps, const DisparityPlane& road) override {
    if (maps.pixel_step > 1) {
      interpolate_disparities(maps.disparity, maps.sigma, road, left_.width(), left_.height(), threads_, disparity_,
                              sigma_);
    }
    return {disparity_, sigma_};
  }

  ImageView<const float> align(const MatchInput& input, ImageView<const float> disparity, const PerspectiveShift& shift,
                               ImageView<const std::uint8_t> mask) override {
    if (options_.lucas_kanade.radius == 0) return disparity;
    const TransformedPair pair{input.reference, input.target, input.first_column, shift, mask};
    lucas_kanade(pair, disparity, options_.lucas_kanade, threads_, restored_, correlation_);
    std::swap(disparity_, restored_);
    return disparity_;
  }

  /// In place.
  ImageView<const float> reject_off_road(ImageView<const float>, const DisparityPriorView& scene,
                                         const PerspectiveShift& shift, const OffRoadOptions& options,
                                         ImageView<const std::uint8_t> mask) override {
    roadstereo::reject_off_road(correlation_, scene, shift, mask, options, threads_, disparity_, sigma_);
    return disparity_;
  }

  /// In place.
  ImageView<const float> subtract_bias(ImageView<const float> disparity, const std::optional<RigBias>& bias) override {
    if (!bias) return disparity;
    roadstereo::subtract_bias(bias_polynomial<float>(*bias), threads_, disparity_);
    return disparity_;
  }

  RollFit estimate_roll(ImageView<const float> disparity, const std::optional<DisparityPlane>& prior,
                        double initial_roll_rad, double min_share, const PerspectiveShift&) override {
    RollFit fit{valid_share(disparity), std::nullopt};
    if (!prior || fit.valid_share < min_share) return fit;
    fit.geometry = geometry_if_determined(
        [&] { return roadstereo::estimate_roll(disparity, {}, prior, initial_roll_rad, options_.roll, threads_); });
    return fit;
  }

  TransformedRoad transform_disparity(ImageView<const float> disparity, const RollEstimate& geometry,
                                      const PerspectiveShift& shift) override {
    const double delta_t =
        roadstereo::transform_disparity(disparity, geometry, shift.delta_p, options_.roll, threads_, transformed_);
    return {delta_t, measure_residuals(transformed_, delta_t, threads_)};
  }

  void invalidate_transformed() override {
    transformed_.assign(left_.width(), left_.height(), std::numeric_limits<float>::quiet_NaN());
  }

  void download(FrameResult& result) override {
    std::swap(result.grey, left_);
    std::swap(result.right, right_);
    std::swap(result.disparity, disparity_);
    std::swap(result.sigma, sigma_);
    std::swap(result.transformed, transformed_);
    result.block_steps = block_steps_;
  }

  void set_device_options(const DeviceOptions&) override { fail_without_device(); }
  DeviceMaps device_maps() override { fail_without_device(); }
  DeviceProfile device_profile() const override { fail_without_device(); }

 private:
  /// Measures the steps between JPEG's blocks in an image, and smooths them.
  void remove_block_steps(int side) {
    GreyImage& grey = side == 0 ? left_ : right_;
    const BlockSteps steps = measure_block_steps(grey);
    block_steps_[static_cast<std::size_t>(side)] = steps.excess();
    if (!options_.deblock) return;
    const int strength = deblocking_strength(steps, BlockStepSamples(grey.width(), grey.height()).count());
    if (strength > 0) smooth_block_steps(grey, strength);
  }

  [[noreturn]] static void fail_without_device() {
    fail("only a pipeline with the engine cuda keeps its maps on a device");
  }

  /// The pixel_step of the maps: an engine may match every pixel. Throws Error for maps of any other size.
  int step_of(const MatchMaps& maps, const MatcherOptions& options) const {
    const int width = maps.disparity.width(), height = maps.disparity.height();
    if (width == left_.width() && height == left_.height()) return 1;
    const int columns = matched_pixels(left_.width(), options), rows = matched_pixels(left_.height(), options);
    if (width != columns || height != rows) {
      fail("the engine ", options_.engine, " has matched ", width, "×", height, " pixels of an image of ",
           left_.width(), "×", left_.height(), "; it must be those or ", columns, "×", rows);
    }
    return options.pixel_step;
  }

  PipelineOptions options_;
  SupportSamples samples_;
  std::optional<StereoCalibration> calibration_;
  int threads_;
  std::unique_ptr<StereoEngine> engine_;
  std::optional<CoarseSearch> coarse_search_;
  CoarseSearch scene_search_;

  GreyImage left_, right_, transformed_target_;
  std::vector<int> first_column_;  ///< of the transformed target
  MatchMaps matched_;
  Image<float> restored_;
  Image<float> refined_, refined_sigma_;  ///< of the matched pixels, where those are not all
  Image<float> correlation_;              ///< of the cells of the Lucas–Kanade step
  std::array<double, 2> block_steps_{};
  Image<float> disparity_, sigma_, transformed_;  ///< results of the frame; earlier ones after `download`
};

}  // namespace

std::unique_ptr<FrameStages> make_host_stages(const PipelineOptions& options,
                                              const std::optional<StereoCalibration>& calibration) {
  return std::make_unique<HostStages>(options, calibration);
}

}  // namespace roadstereo
