#include "pipeline/cuda/device_stages.hpp"

#include "core/cuda/device.hpp"
#include "core/cuda/grey.hpp"
#include "pipeline/cuda/frame_maps.hpp"
#include "pipeline/cuda/frame_upload.hpp"
#include "pipeline/cuda/stage_clock.hpp"
#include "pipeline/pair_checks.hpp"
#include "road/cuda/disparity_transform.hpp"
#include "road/cuda/map_sums.hpp"
#include "road/cuda/perspective.hpp"
#include "road/cuda/road_fit.hpp"
#include "road/cuda/road_verification.hpp"
#include "road/cuda/roll_assessment.hpp"
#include "road/cuda/verification_assessment.hpp"
#include "road/refinement/cuda/refinement_settings.hpp"
#include "road/shift_terms_of.hpp"
#include "roadstereo/device.hpp"
#include "roadstereo/error.hpp"
#include "stereo/coarse/cuda/coarse_search.hpp"
#include "stereo/cuda/device_matcher.hpp"
#include "stereo/window.hpp"

namespace roadstereo::cuda {
namespace {

Device require_device() {
  Device device = find_device();
  if (!device.usable) fail("the engine cuda cannot be used: ", device.reason);
  return device;
}

/// The host waits for the device twice a frame: for the road, which it judges, and for the end.
class DeviceStages final : public FrameStages {
 public:
  /// The device must be usable: members already take memory of it.
  DeviceStages(const PipelineOptions& options, const std::optional<StereoCalibration>& calibration,
               const Device& device)
      : options_(options), calibration_(calibration), device_(device.index), matcher_(device.multiprocessors) {
    if (options.narrow_search || options.matcher.prior_weight > 0) coarse_search_.emplace(options.coarse_search);
  }

  void prepare(const FrameView& left, const FrameView& right, FrameResult&) override {
    require_current_device(device_);  // before memory is taken of another
    clock_.mark(StageClock::begin, stream());
    const FrameUpload::Pair frames = upload_.upload(left, right, options_.white_level, stream());
    width_ = left.width;
    height_ = left.height;
    maps_.resize(width_, height_);
    const std::size_t pixels = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
    right_.reserve(pixels);
    target_.reserve(pixels);
    first_column_.reserve(static_cast<std::size_t>(height_));
    to_grey_.convert(frames.left, frames.right, maps_.grey(), plane(right_), stream());
    clock_.mark(StageClock::prepared, stream());
  }

  GreyPair grey(FrameResult&) override {
    download(maps_.grey(), left_on_host_);
    download(plane(right_), right_on_host_);
    wait_for_pair();
    clock_.mark(StageClock::prepared, stream());
    return {left_on_host_, right_on_host_};
  }

  RoadModelEstimate verify_road(const TrackedRoad& previous, const FrameResult&) override {
    verification_.run(maps_.grey(), plane(right_), {nullptr, plane_terms(previous.model)}, options_.road_model.with_roll,
                      stream());
    wait_for_pair();
    return assess_road_verification(verification_.figures(), previous, width_, height_, calibration_,
                                    options_.road_model);
  }

  void transform_perspective(const FrameResult& result) override {
    clock_.mark(StageClock::road_known, stream());
    transform_target(plane(right_), shift_terms(result.shift), static_cast<float>(grey_max), plane(target_),
                     first_column_.data(), stream());
    clock_.mark(StageClock::transformed_target, stream());
  }

  void search_coarsely(const FrameResult& result) override {
    input_ = {maps_.grey(), plane(target_), first_column_.data(), result.shift.disparities};
    if (coarse_search_ && coarse_search_->find({input_.reference, input_.target, input_.first_column,
                                                input_.disparities, shift_terms(result.shift)},
                                               stream())) {
      if (options_.narrow_search) {
        input_.reference_ranges = coarse_search_->reference_ranges();
        input_.target_ranges = coarse_search_->target_ranges();
      }
      input_.prior = coarse_search_->prior();
      input_.prior_factor = coarse_search_->factor();
    }
    clock_.mark(StageClock::looked, stream());
  }

  void match(const MatcherOptions& options, const FrameResult&) override {
    matched_ = matcher_.match(input_, options, stream());
    clock_.mark(StageClock::matched, stream());
  }

  void refine(FrameResult& result) override {
    cuda::refine_disparities(matched_.disparity, matched_.variance, shift_terms(result.shift),
                             refinement_settings(options_.refinement, effective_samples(options_.matcher)),
                             maps_.disparity(), maps_.sigma(), stream());
    clock_.mark(StageClock::refined, stream());
  }

  bool fit_geometry(const std::optional<DisparityPlane>& prior, double initial_roll_rad, double min_share,
                    FrameResult& result) override;
  void transform(FrameResult& result) override;
  void invalidate_transformed(FrameResult&) override;
  void deliver(FrameResult& result) override;

  void set_device_options(const DeviceOptions& use) override {
    wait();
    stream_ = use.stream != nullptr ? use.stream : own_stream_.get();
    download_ = use.download;
  }

  DeviceMaps device_maps() const override {
    return {width_, height_, maps_.grey().data, maps_.disparity().data, maps_.sigma().data, maps_.transformed().data,
            stream_};
  }

 private:
  cudaStream_t stream() const { return stream_; }
  void wait() const { ROADSTEREO_CUDA(cudaStreamSynchronize(stream_)); }
  Plane<std::int16_t> plane(DeviceArray<std::int16_t>& pixels) const {
    return packed_plane(pixels.data(), width_, height_);
  }

  /// Waits for the device, and refuses what the grey levels show to be no pair.
  void wait_for_pair() {
    wait();
    const PairFindings& found = to_grey_.findings();
    require_pair({{found.left_varies != 0, static_cast<std::int16_t>(found.left_level)},
                  {found.right_varies != 0, static_cast<std::int16_t>(found.right_level)},
                  found.differ == 0});
  }

  template <class T>
  void download(const Plane<T>& from, Image<T>& to) {
    to.resize(width_, height_);
    ROADSTEREO_CUDA(cudaMemcpyAsync(to.row(0), from.data, to.pixels() * sizeof(T), cudaMemcpyDeviceToHost, stream()));
  }

  /// The end of the frame, around a plane that may still lie in device memory.
  void enqueue_transform(const PlaneSource& road, const FrameResult& result) {
    transform_.run(maps_.disparity(), road, {options_.roll.delta_t_px, result.shift.delta_p}, maps_.transformed(),
                   stream());
    clock_.mark(StageClock::transformed, stream());
    if (download_) maps_.download(stream());
  }

  RollEstimate fit_on_host();

  PipelineOptions options_;
  std::optional<StereoCalibration> calibration_;
  int device_;
  Stream own_stream_;
  cudaStream_t stream_ = own_stream_.get();  ///< or the caller's
  bool download_ = true;

  int width_ = 0, height_ = 0;
  FrameUpload upload_;
  PairToGrey to_grey_;
  FrameMaps maps_;
  DeviceArray<std::int16_t> right_, target_;
  DeviceArray<int> first_column_;
  GreyImage left_on_host_, right_on_host_;
  Image<float> disparity_on_host_;
  RoadVerification verification_;
  std::optional<CudaCoarseSearch> coarse_search_;
  DeviceMatchInput input_;
  DeviceMatcher matcher_;
  DeviceMatchMaps matched_;
  RoadFit fit_;
  MapSums sums_;
  DisparityTransform transform_;
  bool transformed_ = false;  ///< the transformation is enqueued already
  StageClock clock_;
};

/// The robust fit around a known road goes on into the transformation without the host. Other solvers come back to it
/// for their plane; without a road before matching, the host searches for one.
bool DeviceStages::fit_geometry(const std::optional<DisparityPlane>& prior, double initial_roll_rad, double min_share,
                                FrameResult& result) {
  const RollOptions& options = options_.roll;
  const MaskedMap map{maps_.disparity(), {}};
  const bool robust = options.solver == RollSolver::robust;
  transformed_ = robust && prior.has_value();
  if (transformed_) {
    fit_.run(map, {nullptr, plane_terms(*prior)}, options.max_iterations, stream());
    clock_.mark(StageClock::fitted, stream());
    enqueue_transform({fit_.plane(), {}}, result);
  } else {
    // The transformation by no plane at all counts what is valid.
    transform_.run(maps_.disparity(), {nullptr, {}}, {0, 0}, maps_.transformed(), stream());
    if (!robust) sums_.run(map, stream());
  }
  wait();
  result.valid_share = static_cast<double>(transform_.figures().valid) / (static_cast<double>(width_) * height_);
  if (result.valid_share < min_share) return false;
  if (transformed_) {
    result.geometry = finish_road_fit(fit_.figures(), width_, height_, options);
  } else if (robust) {
    result.geometry = fit_on_host();
  } else {
    result.geometry = solve_map(sums_.sums(), width_, height_, initial_roll_rad, options);
    fit_.measure(map, plane_terms(result.geometry.plane), stream());
    wait();
    finish_measured(fit_.figures(), width_, height_, options, result.geometry);
  }
  return true;
}

RollEstimate DeviceStages::fit_on_host() {
  download(maps_.disparity(), disparity_on_host_);
  wait();
  return estimate_roll(disparity_on_host_, std::nullopt, std::nullopt, 0, options_.roll, options_.threads);
}

void DeviceStages::transform(FrameResult& result) {
  if (!transformed_) {
    clock_.mark(StageClock::fitted, stream());
    enqueue_transform({nullptr, plane_terms(result.geometry.plane)}, result);
    wait();
  }
  const TransformFigures& found = transform_.figures();
  result.delta_t = found.delta_t;
  result.spread = {found.sigma_road_px, found.sigma_all_px, found.road_share};
}

void DeviceStages::invalidate_transformed(FrameResult&) {
  clock_.mark(StageClock::fitted, stream());
  constexpr int every_bit = 0xFF;  // a NaN
  const std::size_t bytes = sizeof(float) * static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  ROADSTEREO_CUDA(cudaMemsetAsync(maps_.transformed().data, every_bit, bytes, stream()));
  clock_.mark(StageClock::transformed, stream());
  if (download_) maps_.download(stream());
}

void DeviceStages::deliver(FrameResult& result) {
  wait();
  clock_.read(result.ms);
  if (download_) {
    maps_.take(result);
  } else {
    for (Image<float>* map : {&result.disparity, &result.sigma, &result.transformed}) map->resize(0, 0);
    result.grey.resize(0, 0);
  }
}

}  // namespace

std::unique_ptr<FrameStages> make_device_stages(const PipelineOptions& options,
                                                const std::optional<StereoCalibration>& calibration) {
  return std::make_unique<DeviceStages>(options, calibration, require_device());
}

}  // namespace roadstereo::cuda
