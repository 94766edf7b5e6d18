#include "pipeline/cuda/device_stages.hpp"

#include <algorithm>
#include <cmath>

#include "core/cuda/deblocking.hpp"
#include "core/cuda/device.hpp"
#include "core/cuda/gaussian_smoothing.hpp"
#include "core/cuda/grey.hpp"
#include "pipeline/cuda/frame_maps.hpp"
#include "pipeline/cuda/frame_upload.hpp"
#include "pipeline/cuda/stage_clock.hpp"
#include "pipeline/pair_checks.hpp"
#include "pipeline/support_samples.hpp"
#include "road/cuda/disparity_transform.hpp"
#include "road/cuda/map_sums.hpp"
#include "road/cuda/perspective.hpp"
#include "road/cuda/rig_bias.hpp"
#include "road/cuda/road_fit.hpp"
#include "road/cuda/road_verification.hpp"
#include "road/cuda/roll_assessment.hpp"
#include "road/cuda/verification_assessment.hpp"
#include "road/lucas_kanade/cuda/lucas_kanade.hpp"
#include "road/lucas_kanade/settings.hpp"
#include "road/off_road/cuda/off_road.hpp"
#include "road/refinement/cuda/interpolation.hpp"
#include "road/refinement/cuda/refinement_settings.hpp"
#include "road/roll_assessment.hpp"
#include "road/row_shift.hpp"
#include "roadstereo/device.hpp"
#include "roadstereo/error.hpp"
#include "stereo/coarse/cuda/coarse_search.hpp"
#include "stereo/cuda/device_matcher.hpp"

namespace roadstereo::cuda {
namespace {

Device require_device() {
  Device device = find_device();
  if (!device.usable) fail("the engine cuda cannot be used: ", device.reason);
  return device;
}

/// The host waits for the device twice a frame: for the road, which it assesses, and for the end. docs/architecture.md
/// says why there is no CUDA graph.
class DeviceStages final : public FrameStages {
 public:
  /// The device must be usable: members already take memory of it.
  DeviceStages(const PipelineOptions& options, const std::optional<StereoCalibration>& calibration,
               const Device& device)
      : options_(options),
        samples_(options.matcher),
        calibration_(calibration),
        device_(device.index),
        programmatic_(device.programmatic_launch),
        scene_search_(options.coarse_search),
        matcher_(device.multiprocessors) {
    if (options.narrow_search || options.matcher.prior_weight > 0) coarse_search_.emplace(options.coarse_search);
  }
  /// Memory goes only when no kernel uses it any more. The stream may be the caller's.
  ~DeviceStages() override { DeviceStages::abandon(); }
  DeviceStages(const DeviceStages&) = delete;
  DeviceStages& operator=(const DeviceStages&) = delete;

  void abandon() noexcept override {
    stream().settle();
    matcher_.settle();
    fit_.settle();
    maps_.settle();
  }

  GreyPair convert_to_grey(const FrameView& left, const FrameView& right, double white_level) override {
    require_current_device(device_);  // before memory is taken of another
    if (recorder_) recorder_->begin();
    mark(StageClock::begin);
    const FrameUpload::Pair frames = upload_.upload(left, right, white_level, stream());
    resize(left.width, left.height);
    to_grey_.convert(frames.left, frames.right, maps_.grey(), view(right_), stream());
    deblocking_.run(maps_.grey(), view(right_), options_.deblock, stream());
    mark(StageClock::converted);
    return {maps_.grey(), view(right_)};
  }

  GreyPair on_host(const GreyPair& pair) override {
    copy_to_host(pair.left, left_on_host_);
    copy_to_host(pair.right, right_on_host_);
    wait_for_pair();
    return {left_on_host_, right_on_host_};
  }

  GreyPair smooth(const GreyPair& pair, double variance_px2) override {
    smooth_image(smoothing_kernel(std::abs(variance_px2)), variance_px2 > 0 ? maps_.grey() : view(right_),
                 view(target_), stream());
    return pair;
  }

  GreyPair undo_misalignment(const GreyPair& pair, const Misalignment& misalignment) override {
    transform_target(pair.right, without_road(misalignment), static_cast<float>(grey_max), view(target_),
                     first_column_.data(), stream());
    return {pair.left, view(target_)};
  }

  RoadModelEstimate verify_road_model(const GreyPair& pair, const TrackedRoad& previous) override {
    verification_.run(pair.left, pair.right, {nullptr, previous.model}, options_.road_model.with_roll, stream());
    wait_for_pair();
    return assess_road_verification(verification_.statistics(), previous, width_, height_, calibration_,
                                    options_.road_model);
  }

  MatchInput transform_perspective(const GreyPair& pair, const PerspectiveShift& shift) override {
    mark(StageClock::road_known);
    transform_target(pair.right, shift, static_cast<float>(grey_max), view(target_), first_column_.data(), stream());
    mark(StageClock::transformed_target);
    return {pair.left, view(target_), first_column_.data(), shift.disparities, {}, {}};
  }

  MatchInput search_coarsely(const MatchInput& pair, const PerspectiveShift& shift,
                             const CoarseSearchOptions& options) override {
    MatchInput input = pair;
    if (coarse_search_) coarse_search_->set_options(options);
    if (coarse_search_ && coarse_search_->find(pair, shift, stream())) {
      if (options_.narrow_search) input.ranges = coarse_search_->ranges();
      input.prior = coarse_search_->prior();
    }
    mark(StageClock::searched);
    return input;
  }

  DisparityPriorView search_scene(const MatchInput& pair, const PerspectiveShift& shift,
                                  const CoarseSearchOptions& options) override {
    scene_search_.set_options(options);
    const bool found = scene_search_.find_prior(pair, shift, stream());
    mark(StageClock::searched);
    return found ? scene_search_.prior() : DisparityPriorView{};
  }

  ResidualMaps match(const MatchInput& input, const MatcherOptions& options) override {
    const DeviceMatchMaps& matched = matcher_.match(input, options, stream());
    mark(StageClock::matched);
    return {matched.disparity, matched.variance, samples_.of(options), options.pixel_step};
  }

  /// In place.
  DisparityMaps restore_disparity(const ResidualMaps& residual, const PerspectiveShift& shift) override {
    cuda::restore_disparity(residual.disparity, shift, residual.pixel_step, residual.disparity, stream());
    return {residual.disparity, residual.variance, residual.samples, residual.pixel_step};
  }

  RefinedMaps refine(const DisparityMaps& maps, const DisparityPlane& road) override {
    const int columns = maps.disparity.width(), rows = maps.disparity.height(), step = maps.pixel_step;
    const auto between = [&](std::ptrdiff_t index) {
      return ImageView<float>(between_.data() + index * columns * rows, columns, rows);
    };
    const ImageView<float> last = step == 1 ? maps_.disparity() : between(2);
    const ImageView<float> last_error = step == 1 ? maps_.sigma() : between(3);
    const cuda::SlopeMaps slopes{between(step == 1 ? 2 : 4), between(step == 1 ? 3 : 5)};
    const RefinementOptions options = of_matched_pixels(options_.refinement, step);
    const double samples = of_matched_pixels(maps.samples, step);
    DisparityMaps from = maps;
    const int passes = pass_count(options);
    for (int k = 0; k < passes; ++k) {
      const bool to_result = (passes - 1 - k) % 2 == 0;
      const ImageView<float> refined = to_result ? last : between(0);
      const ImageView<float> error = to_result ? last_error : between(1);
      cuda::refine_disparities(from.disparity, from.variance, of_matched_pixels(road, step),
                               refinement_settings(options, k, samples), slopes, refined, error, stream());
      from.disparity = refined;
      from.variance = error;
    }
    return {last, last_error, step};
  }

  InterpolatedMaps interpolate(const RefinedMaps& maps, const DisparityPlane& road) override {
    if (maps.pixel_step > 1) {
      interpolate_disparities(maps.disparity, maps.sigma, road, maps_.disparity(), maps_.sigma(), stream());
    }
    return {maps_.disparity(), maps_.sigma()};
  }

  /// There is never a mask on a device.
  ImageView<const float> align(const MatchInput& input, ImageView<const float> disparity, const PerspectiveShift& shift,
                               ImageView<const std::uint8_t>) override {
    if (options_.lucas_kanade.radius > 0) {
      const TransformedPair pair{input.reference, input.target, input.first_column, shift};
      correlation_ = lucas_kanade_.run(pair, disparity, options_.lucas_kanade.radius,
                                       alignment_settings(options_.lucas_kanade), maps_.disparity(), stream());
    }
    return maps_.disparity();
  }

  ImageView<const float> reject_off_road(ImageView<const float>, const DisparityPriorView& scene,
                                         const PerspectiveShift& shift, const OffRoadOptions& options,
                                         ImageView<const std::uint8_t>) override {
    off_road_.run({scene.disparity, scene.factor, shift}, correlation_, static_cast<float>(options.max_sigma_px),
                  maps_.disparity(), maps_.sigma(), stream());
    return maps_.disparity();
  }

  /// In place.
  ImageView<const float> subtract_bias(ImageView<const float>, const std::optional<RigBias>& bias) override {
    if (bias) cuda::subtract_bias(bias_polynomial<float>(*bias), maps_.disparity(), stream());
    mark(StageClock::refined);
    if (download_) maps_.download_refined(view(right_), stream());
    return maps_.disparity();
  }

  RollFit estimate_roll(ImageView<const float> disparity, const std::optional<DisparityPlane>& prior,
                        double initial_roll_rad, double min_share, const PerspectiveShift& shift) override;
  TransformedRoad transform_disparity(ImageView<const float> disparity, const RollEstimate& geometry,
                                      const PerspectiveShift& shift) override;
  void invalidate_transformed() override;
  void download(FrameResult& result) override;

  void set_device_options(const DeviceOptions& use) override {
    require_current_device(device_);  // before events are made on another
    wait();
    stream_ = use.stream != nullptr ? use.stream : own_stream_.get();
    download_ = use.download;
    clock_.reset();
    recorder_.reset();
    if (use.timing != DeviceTiming::none) clock_.emplace();
    if (use.timing == DeviceTiming::kernels) recorder_.emplace();
  }

  DeviceProfile device_profile() const override {
    if (!recorder_) fail("only a pipeline with DeviceTiming::kernels knows its kernels");
    return recorder_->profile();
  }

  DeviceMaps device_maps() override {
    return {width_,
            height_,
            maps_.grey().data(),
            maps_.disparity().data(),
            maps_.sigma().data(),
            maps_.transformed().data(),
            stream_,
            is_emulated ? -1 : device_,
            maps_.hold()};
  }

 private:
  StreamView stream() { return {stream_, recorder_ ? &*recorder_ : nullptr, programmatic_}; }
  void wait() {
    stream().wait();
    complete_ = true;
  }
  void mark(StageClock::Mark at) {
    if (clock_) clock_->mark(at, stream());
  }
  ImageView<std::int16_t> view(DeviceArray<std::int16_t>& pixels) const {
    return ImageView(pixels.data(), width_, height_);
  }

  void resize(int width, int height) {
    width_ = width;
    height_ = height;
    maps_.begin(width, height);
    const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    right_.reserve(pixels);
    target_.reserve(pixels);
    first_column_.reserve(static_cast<std::size_t>(height));
    const auto matched = [](int side) { return static_cast<std::size_t>(side + 1) / 2; };  // of every second pixel
    between_.reserve(options_.matcher.pixel_step == 1 ? 4 * pixels : 6 * matched(width) * matched(height));
  }

  /// Waits for the device. Throws Error where the grey levels cannot be those of a pair.
  void wait_for_pair() {
    wait();
    const PairFindings& found = to_grey_.findings();
    require_pair({{found.left_varies != 0, static_cast<std::int16_t>(found.left_level)},
                  {found.right_varies != 0, static_cast<std::int16_t>(found.right_level)},
                  found.differ == 0});
  }

  template <class T>
  void copy_to_host(const ImageView<const T>& from, Image<T>& to) {
    to.resize(width_, height_);
    stream().download(to.row(0), from.data(), to.pixels() * sizeof(T));
  }

  /// The end of the frame, around a plane that may still lie in device memory.
  void enqueue_transform(ImageView<const float> disparity, const PlaneSource& road, const PerspectiveShift& shift) {
    transform_.run(disparity, road, {options_.roll.delta_t_px, shift.delta_p}, maps_.transformed(), stream());
    mark(StageClock::transformed);
    complete_ = false;
    if (download_) maps_.download_transformed(stream());
  }

  PipelineOptions options_;
  SupportSamples samples_;
  std::optional<StereoCalibration> calibration_;
  int device_;
  bool programmatic_;
  Stream own_stream_;
  cudaStream_t stream_ = own_stream_.get();  ///< or the caller's
  bool download_ = true;

  int width_ = 0, height_ = 0;
  FrameUpload upload_;
  PairToGrey to_grey_;
  PairDeblocking deblocking_;
  FrameMaps maps_;
  DeviceArray<std::int16_t> right_, target_;
  DeviceArray<int> first_column_;
  /// Disparities and variances between two passes of the refinement, of every second pixel after the last, too; slopes.
  DeviceArray<float> between_;
  GreyImage left_on_host_, right_on_host_;
  RoadVerification verification_;
  std::optional<CudaCoarseSearch> coarse_search_;
  CudaCoarseSearch scene_search_;
  DeviceMatcher matcher_;
  LucasKanade lucas_kanade_;
  ImageView<const float> correlation_;  ///< of the cells of that step
  OffRoad off_road_;
  RoadFit fit_;
  MapSums sums_;
  DisparityTransform transform_;
  bool complete_ = false;            ///< the host has waited for the transformed map
  std::optional<StageClock> clock_;  ///< DeviceOptions::timing
  std::optional<Recorder> recorder_;
};

/// Goes on into the transformation without the host. Without a road it only counts.
RollFit DeviceStages::estimate_roll(ImageView<const float> disparity, const std::optional<DisparityPlane>& prior,
                                    double initial_roll_rad, double min_share, const PerspectiveShift& shift) {
  const RollOptions& options = options_.roll;
  const MaskedMap map{disparity, {}};
  const bool robust = options.solver == RollSolver::robust;
  if (prior) {
    if (robust) {
      fit_.run(map, {nullptr, *prior}, options.max_iterations, stream());
    } else {
      sums_.run(map, roll_from_sums(initial_roll_rad, options), stream());
      fit_.measure(map, {sums_.plane(), {}}, stream());
    }
    mark(StageClock::fitted);
    enqueue_transform(disparity, {robust ? fit_.plane() : sums_.plane(), {}}, shift);
    fit_.join(stream());
  } else {
    // The transformation by no plane at all counts what is valid.
    transform_.run(disparity, {nullptr, {}}, {0, 0}, maps_.transformed(), stream());
  }
  wait();
  RollFit fit{static_cast<double>(transform_.statistics().valid) / (static_cast<double>(width_) * height_),
              std::nullopt};
  if (!prior || fit.valid_share < min_share) return fit;
  fit.geometry = geometry_if_determined([&] {
    if (robust) return finish_road_fit(fit_.statistics(), width_, height_, options);
    return finish_solved(sums_.solved(), fit_.statistics(), width_, height_, options);
  });
  return fit;
}

/// As estimate_roll has enqueued it.
TransformedRoad DeviceStages::transform_disparity(ImageView<const float>, const RollEstimate&,
                                                  const PerspectiveShift&) {
  const TransformStatistics& found = transform_.statistics();
  return {found.delta_t, {found.sigma_road_px, found.sigma_all_px, found.road_share}};
}

void DeviceStages::invalidate_transformed() {
  mark(StageClock::fitted);
  constexpr int every_bit = 0xFF;  // a NaN
  const std::size_t bytes = sizeof(float) * static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  ROADSTEREO_CUDA(cudaMemsetAsync(maps_.transformed().data(), every_bit, bytes, stream_));
  mark(StageClock::transformed);
  complete_ = false;
  if (download_) maps_.download_transformed(stream());
}

void DeviceStages::download(FrameResult& result) {
  if (!complete_) wait();
  if (clock_) clock_->read(result.ms);
  result.block_steps = deblocking_.excess();
  if (download_) {
    maps_.take(result);
  } else {
    for (Image<float>* map : {&result.disparity, &result.sigma, &result.transformed}) map->resize(0, 0);
    for (GreyImage* image : {&result.grey, &result.right}) image->resize(0, 0);
  }
}

}  // namespace

std::unique_ptr<FrameStages> make_device_stages(const PipelineOptions& options,
                                                const std::optional<StereoCalibration>& calibration) {
  return std::make_unique<DeviceStages>(options, calibration, require_device());
}

}  // namespace roadstereo::cuda
