#include "roadstereo/pipeline.hpp"

#include <algorithm>
#include <utility>

#include "core/parallel.hpp"
#include "core/require_size.hpp"
#include "pipeline/host_stages.hpp"
#include "pipeline/pipeline_steps.hpp"
#include "road/rig_prior.hpp"
#include "roadstereo/device.hpp"
#include "roadstereo/error.hpp"
#if defined(ROADSTEREO_WITH_CUDA)
#include "pipeline/cuda/device_stages.hpp"
#endif

namespace roadstereo {
namespace {

std::unique_ptr<FrameStages> make_stages(const std::string& engine, const PipelineOptions& options,
                                         const std::optional<StereoCalibration>& calibration) {
#if defined(ROADSTEREO_WITH_CUDA)
  if (engine == "cuda") return cuda::make_device_stages(options, calibration);
#endif
  static_cast<void>(engine);
  return make_host_stages(options, calibration);
}

bool masks_nothing(ImageView<const std::uint8_t> mask) {
  for (int v = 0; v < mask.height(); ++v) {
    const std::uint8_t* const row = mask.row(v);
    if (std::any_of(row, row + mask.width(), [](std::uint8_t value) { return value != 0; })) return false;
  }
  return true;
}

}  // namespace

/// Checks the sizes. Images of a new size reset the state.
void Pipeline::State::begin_frame(const FrameView& left, const FrameView& right) {
  begin = Clock::now();
  has_frame = has_maps = has_profile = false;
  result.warnings.clear();
  result.ms = {};
  require_one_size({left.width, left.height}, {right.width, right.height});
  width = left.width;
  height = left.height;
  require_mask_size({mask.width(), mask.height()}, {width, height});
  if (calibration) calibration->validate(width, height, "calibration");
  if (options.rig_bias) options.rig_bias->require_rig(width, height, calibration);
  if (carried.width != width || carried.height != height) {
    carried = {};
    carried.width = width;
    carried.height = height;
  }
}

void Pipeline::State::run_stages(const FrameView& left, const FrameView& right) {
  const GreyPair pair = equalise_blur(convert_to_grey(left, right));
  estimate_road_model(pair);
  const MatchInput transformed = transform_perspective(pair);
  const MatchInput input = search_coarsely(transformed);
  const DisparityPriorView whole_scene = search_scene(transformed);
  const ResidualMaps residual = match(input);
  const DisparityMaps restored = restore_disparity(residual);
  const RefinedMaps refined = refine(restored);
  const ImageView<const float> interpolated = interpolate(refined);
  const ImageView<const float> aligned = align(input, interpolated);
  const ImageView<const float> confirmed = reject_off_road(aligned, whole_scene);
  const ImageView<const float> disparity = subtract_bias(confirmed);
  estimate_roll(disparity);
  transform_disparity(disparity);
  download();
}

/// Sets the total time and the state that the next frame starts from.
void Pipeline::State::end_frame() {
  result.ms.total = ms_since(begin);
  result.mask = mask;
  result.rig_bias = options.rig_bias;
  if (options.check_rows) ++carried.frames_since_rows;
  if (options.equalise_blur) ++carried.frames_since_blur;
  carried.road.reset();
  if (result.road.has_road()) {
    carried.road = TrackedRoad{result.road.model, result.road.inlier_share, result.road.correlation,
                               result.road.samples_are_cells};
  }
  carried.roll_rad = result.roll_found && result.geometry.roll_observable ? result.geometry.roll_rad : 0;
  result.mde_per_s = static_cast<double>(width) * height * result.shift.disparities / (result.ms.total * 1e-3) * 1e-6;
  has_frame = has_maps = has_profile = true;
}

Pipeline::Pipeline(const PipelineOptions& options, const std::optional<StereoCalibration>& calibration)
    : state_(std::make_unique<State>()) {
  options.validate();
  const RigPrior checked(options.road_model, calibration);
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
  const PipelineState before = s.carried;
  s.begin_frame(left, right);
  try {
    s.run_stages(left, right);
  } catch (...) {
    s.stages->abandon();
    s.carried = before;
    throw;
  }
  s.end_frame();
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

const PipelineState& Pipeline::carried() const {
  return state_->carried;
}

void Pipeline::restore(const PipelineState& carried) {
  carried.validate();
  state_->has_frame = state_->has_maps = state_->has_profile = false;
  state_->carried = carried;
}

void Pipeline::set_mask(ImageView<const std::uint8_t> mask) {
  if (masks_nothing(mask)) mask = {};
  if (state_->engine_name == "cuda" && !mask.empty()) {
    if (state_->options.engine != "auto") fail("the engine cuda takes no mask; use another one, such as cpu");
    if (state_->is_shared) {
      fail("the engine cuda takes no mask, and set_device_options has asked for a device; use the engine cpu");
    }
    PipelineOptions on_host = state_->options;
    on_host.engine = "cpu";
    state_->stages = make_stages(on_host.engine, on_host, state_->calibration);
    state_->engine_name = on_host.engine;
    state_->has_frame = state_->has_maps = state_->has_profile = false;
  }
  state_->mask.resize(mask.width(), mask.height());
  for (int v = 0; v < mask.height(); ++v) std::copy_n(mask.row(v), mask.width(), state_->mask.row(v));
}

void Pipeline::set_white_level(double level) {
  if (level == state_->options.white_level) return;
  PipelineOptions changed = state_->options;
  changed.white_level = level;
  changed.validate();
  state_->options.white_level = level;
}

void Pipeline::set_device_options(const DeviceOptions& use) {
  state_->stages->set_device_options(use);
  state_->is_shared = use.stream != nullptr || !use.download || use.timing != DeviceTiming::none;
  state_->has_frame = state_->has_profile = false;
}

DeviceMaps Pipeline::device_maps() const {
  DeviceMaps maps = state_->stages->device_maps();
  if (!state_->has_maps) fail("no frame was processed yet, or the last one was refused or forgotten");
  return maps;
}

DeviceProfile Pipeline::device_profile() const {
  DeviceProfile profile = state_->stages->device_profile();
  if (!state_->has_profile)
    fail("no frame was processed yet with this timing, or the last one was refused or forgotten");
  return profile;
}

void Pipeline::reset() {
  restore({});
}

const PipelineOptions& Pipeline::options() const {
  return state_->options;
}
const std::optional<StereoCalibration>& Pipeline::calibration() const {
  return state_->calibration;
}
const std::string& Pipeline::engine_name() const {
  return state_->engine_name;
}

}  // namespace roadstereo
