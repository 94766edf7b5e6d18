#include "roadstereo/pipeline.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "core/parallel.hpp"
#include "core/scratch.hpp"
#include "core/sentence.hpp"
#include "pipeline/host_stages.hpp"
#include "roadstereo/device.hpp"
#include "roadstereo/error.hpp"
#if defined(ROADSTEREO_WITH_CUDA)
#include "pipeline/cuda/device_stages.hpp"
#endif

namespace roadstereo {
namespace {

/// Milliseconds since it was made or last read.
class Stopwatch {
 public:
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const double ms = std::chrono::duration<double, std::milli>(now - last_).count();
    last_ = now;
    return ms;
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

std::unique_ptr<FrameStages> make_stages(const std::string& engine, const PipelineOptions& options,
                                         const std::optional<StereoCalibration>& calibration) {
#if defined(ROADSTEREO_WITH_CUDA)
  if (engine == "cuda") return cuda::make_device_stages(options, calibration);
#endif
  static_cast<void>(engine);
  return make_host_stages(options, calibration);
}

}  // namespace

struct Pipeline::State {
  PipelineOptions options;
  std::optional<StereoCalibration> calibration;
  std::string engine_name;
  int threads = 1;
  std::unique_ptr<FrameStages> stages;

  PipelineState carried;
  int width = 0, height = 0;  ///< of the frame, pixels
  bool has_frame = false;     ///< whether `result` belongs to one frame, whole
  bool has_maps = false;      ///< whether the maps that a device keeps do

  std::pmr::unsynchronized_pool_resource memory{{.max_blocks_per_chunk = 1, .largest_required_pool_block = 4U << 20}};
  FrameResult result;

  void prepare(const FrameView& left_frame, const FrameView& right_frame);
  void find_road();
  void measure_rows(const GreyPair& grey);
  void transform_perspective();
  void match();
  void find_geometry();
  void transform();
  void summarise();
};

/// Converts both images to grey and refuses what cannot be a pair.
void Pipeline::State::prepare(const FrameView& left_frame, const FrameView& right_frame) {
  if (left_frame.width != right_frame.width || left_frame.height != right_frame.height) {
    fail("the left image has ", left_frame.width, "×", left_frame.height, " pixels and the right image ",
         right_frame.width, "×", right_frame.height, "; a pair must have one size");
  }
  width = left_frame.width;
  height = left_frame.height;
  if (calibration) calibration->validate(left_frame.width, left_frame.height, "calibration");
  if (carried.width != left_frame.width || carried.height != left_frame.height) carried.road.reset();
  stages->prepare(left_frame, right_frame, result);
}

/// The road model Δu (eq. relation_vd): the last frame's when it still fits, else from the images.
void Pipeline::State::find_road() {
  result.rows = {};
  if (carried.road) {
    result.road = stages->verify_road(*carried.road, result);
    if (result.road.reliable) return;
    result.warnings.push_back(sentence("the road model was estimated anew: ", result.road.reason));
  }
  const GreyPair grey = stages->grey(result);
  result.road = estimate_road_model(grey.left, grey.right, calibration, options.road_model, threads);
  if (!result.road.reliable) {
    result.warnings.push_back(sentence("no road was found (", result.road.reason,
                                       "): matched without perspective transformation over the full range"));
  } else if (result.road.status == RoadStatus::weak) {
    result.warnings.push_back(sentence("the road is weak: the evidence for it is ", result.road.evidence,
                                       " per pixel, less than ", options.road_model.weak_evidence));
  }
  if (options.check_rows) measure_rows(grey);
}

void Pipeline::State::measure_rows(const GreyPair& grey) {
  constexpr double max_offset_px = 0.5;
  constexpr double max_spread_px = 1.0;
  result.rows = measure_row_alignment(grey.left, grey.right, threads);
  carried.row_offset_px = 0;
  if (!result.rows.known()) return;
  constexpr double max_correction_px = 2.0;
  constexpr double min_correction_px = 0.1;
  const double offset = std::abs(result.rows.median_px);
  if (options.correct_rows && offset >= min_correction_px && offset <= max_correction_px &&
      result.rows.sigma_px <= max_spread_px) {
    carried.row_offset_px = result.rows.median_px;
  }
  if (std::abs(result.rows.median_px) > max_offset_px || result.rows.sigma_px > max_spread_px) {
    result.warnings.push_back(sentence("the rows of the pair do not agree: vertical offset ", result.rows.median_px,
                                       " px (median of ", result.rows.points, " points, spread ", result.rows.sigma_px,
                                       " px); rectify the pair"));
  }
}

/// π_tar → π_tar', section 3.1.
void Pipeline::State::transform_perspective() {
  result.shift = plan_perspective(result.road, calibration, width, height, options.perspective);
  result.shift.row_offset = carried.row_offset_px;
  stages->transform_perspective(result);
}

/// Section 3.2. Without a road the coarse map has only its rows to go by, and matching leans on it less far.
void Pipeline::State::match() {
  constexpr double reach_without_road_px = 2;
  MatcherOptions matcher = options.matcher;
  if (!result.shift.enabled) matcher.prior_truncation_px = std::min(matcher.prior_truncation_px, reach_without_road_px);
  stages->match(matcher, result);
}

/// Roll angle and projection model, section 3.3.
void Pipeline::State::find_geometry() {
  // Of a pair without a road nothing is told but its disparities.
  constexpr double min_valid_share = 0.01, never = 2;
  result.geometry = {};
  const bool has_road = result.road.status != RoadStatus::none;
  result.roll_found = stages->fit_geometry(has_road ? std::optional(result.road.model) : std::nullopt,
                                           carried.roll_rad, has_road ? min_valid_share : never, result);
  if (has_road && !result.roll_found) {
    result.warnings.push_back(sentence("only ", 100 * result.valid_share, " % of the pixels have a disparity"));
  }
}

/// ℓ → ℓ' (eq. disparity_transformation). δt is at least δp, so that it stays the same from frame to frame of a flight.
void Pipeline::State::transform() {
  result.delta_t = 0;
  result.spread = {};
  if (!result.roll_found) {
    stages->invalidate_transformed(result);
    return;
  }
  stages->transform(result);
}

/// What the next frame starts from, and the figures of this one.
void Pipeline::State::summarise() {
  carried.width = width;
  carried.height = height;
  carried.road.reset();
  if (result.road.reliable) carried.road = TrackedRoad{result.road.model, result.road.inlier_share};
  carried.roll_rad = result.roll_found && result.geometry.roll_observable ? result.geometry.roll_rad : 0;
  result.mde_per_s = static_cast<double>(width) * height * result.shift.disparities / (result.ms.total * 1e-3) * 1e-6;
}

Pipeline::Pipeline(const PipelineOptions& options, const std::optional<StereoCalibration>& calibration)
    : state_(std::make_unique<State>()) {
  options.validate();
  state_->options = options;
  state_->calibration = calibration;
  state_->engine_name = resolve_engine_name(options.engine);
  state_->threads = resolve_threads(options.threads);
  state_->stages = make_stages(state_->engine_name, options, calibration);
}

Pipeline::~Pipeline() = default;
Pipeline::Pipeline(Pipeline&&) noexcept = default;
Pipeline& Pipeline::operator=(Pipeline&&) noexcept = default;

const FrameResult& Pipeline::process(const FrameView& left, const FrameView& right) {
  State& s = *state_;
  const ScratchScope scratch(s.memory);
  s.has_frame = s.has_maps = false;
  s.result.warnings.clear();
  Stopwatch frame, watch;
  s.prepare(left, right);
  s.result.ms.prepare = watch.lap();
  s.find_road();
  s.result.ms.road_model = watch.lap();
  s.transform_perspective();
  s.result.ms.perspective = watch.lap();
  s.stages->search_coarsely(s.result);
  s.result.ms.coarse = watch.lap();
  s.match();
  s.result.ms.match = watch.lap();
  s.stages->refine(s.result);
  s.result.ms.refinement = watch.lap();
  s.find_geometry();
  s.result.ms.roll = watch.lap();
  s.transform();
  s.result.ms.transform = watch.lap();
  s.stages->deliver(s.result);
  s.result.ms.deliver = watch.lap();
  s.result.ms.total = frame.lap();
  s.summarise();
  s.has_frame = s.has_maps = true;
  return s.result;
}

void Pipeline::process(const FrameView& left, const FrameView& right, FrameResult& result) {
  process(left, right);
  std::swap(state_->result, result);
  state_->has_frame = false;
}

DamageMap Pipeline::find_damage() const {
  DamageMap result;
  find_damage(result);
  return result;
}

void Pipeline::find_damage(DamageMap& result) const {
  const State& s = *state_;
  if (!s.has_frame) fail("no frame was processed yet, or the last one was refused or handed out");
  roadstereo::find_damage(s.result, s.calibration, s.options.damage, s.threads, result);
}

DamageMap find_damage(const FrameResult& frame, const std::optional<StereoCalibration>& calibration,
                      const DamageOptions& options, int threads) {
  DamageMap result;
  find_damage(frame, calibration, options, threads, result);
  return result;
}

void find_damage(const FrameResult& frame, const std::optional<StereoCalibration>& calibration,
                 const DamageOptions& options, int threads, DamageMap& result) {
  if (frame.disparity.empty()) {
    fail("the frame has no maps on the host, where damage is looked for: it is none, or they were left on the device");
  }
  if (!frame.roll_found) {
    result = make_empty_damage_map(frame.disparity.width(), frame.disparity.height(), "no road was found");
    return;
  }
  DamageInput input;
  input.transformed = frame.transformed;
  input.disparity = frame.disparity;
  input.sigma = frame.sigma;
  input.grey = frame.grey;
  input.plane = frame.geometry.plane;
  input.calibration = calibration;
  find_damage(input, options, threads, result);
}

const PipelineState& Pipeline::carried() const {
  return state_->carried;
}

void Pipeline::restore(const PipelineState& carried) {
  state_->has_frame = state_->has_maps = false;
  state_->carried = carried;
}

void Pipeline::set_device_options(const DeviceOptions& use) {
  state_->has_frame = false;
  state_->stages->set_device_options(use);
}

DeviceMaps Pipeline::device_maps() const {
  const DeviceMaps maps = state_->stages->device_maps();
  if (!state_->has_maps) fail("no frame was processed yet, or the last one was refused or forgotten");
  return maps;
}

void Pipeline::reset() {
  restore({});
}

const PipelineOptions& Pipeline::options() const {
  return state_->options;
}
const std::string& Pipeline::engine_name() const {
  return state_->engine_name;
}

}  // namespace roadstereo
