#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "roadstereo/alignment.hpp"
#include "roadstereo/blur_difference.hpp"
#include "roadstereo/calibration.hpp"
#include "roadstereo/coarse_search.hpp"
#include "roadstereo/damage.hpp"
#include "roadstereo/image.hpp"
#include "roadstereo/lucas_kanade.hpp"
#include "roadstereo/matcher.hpp"
#include "roadstereo/off_road.hpp"
#include "roadstereo/perspective.hpp"
#include "roadstereo/refinement.hpp"
#include "roadstereo/rig_bias.hpp"
#include "roadstereo/road_model.hpp"
#include "roadstereo/roll.hpp"

#pragma GCC visibility push(default)
namespace roadstereo {

struct DeviceOptions;
struct DeviceMaps;
struct DeviceProfile;

struct PipelineOptions {
  std::string engine = "auto";  ///< a name from engines(), or "auto"
  int threads = 0;              ///< worker threads; 0 takes all cores
  double white_level = 0;       ///< sample value of white, 0 … 65535; 0 takes 255 or 65535 by the sample type
  bool deblock = true;        ///< smooth the steps between the blocks of 8×8 pixels that JPEG leaves, where they show
  bool check_rows = true;     ///< measure the vertical alignment of the rows: whenever the road is searched without
                              ///< tracking, and on a tracked road every 100 frames, or every 10 while the alignment
                              ///< is unknown
  bool correct_rows = true;   ///< undo the misalignment, up to 8 px, that `check_rows` has measured
  bool equalise_blur = true;  ///< smooth the sharper image of a pair of which one is blurred more, by defocus: measured
                              ///< in the first frame, and every 100 frames
  bool narrow_search = true;  ///< search each tile only near the disparities that the coarse search finds there
  RoadModelOptions road_model;
  PerspectiveOptions perspective;
  CoarseSearchOptions coarse_search;
  MatcherOptions matcher;
  RefinementOptions refinement;
  LucasKanadeOptions lucas_kanade;
  OffRoadOptions off_road;  ///< applied only with Scope::road and the Lucas–Kanade step. If the horizon is outside the
                            ///< image, σ is not tested, and only disparities that the scene contradicts are rejected
  RollOptions roll;
  DamageOptions damage;             ///< of `Pipeline::find_damage`
  std::optional<RigBias> rig_bias;  ///< disparity error of the rig, subtracted from the disparities of the left image

  /// Throws Error naming the first option that is out of range.
  void validate() const;
};

/// Returns a preset: "default", "fast" (highest speed) or "paper" (every constant of the paper). Throws Error for other
/// names.
PipelineOptions preset(const std::string& name);
const std::vector<std::string>& preset_names();

/// Times of the stages of one frame, milliseconds.
struct StageTimes {
  double prepare = 0;  ///< conversion to grey, checks of the pair
  double road_model = 0;
  double perspective = 0;
  double coarse = 0;      ///< coarse search: disparity range of each tile, prior
  double match = 0;       ///< cost, aggregation, winner-take-all, left–right check, sub-pixel
  double refinement = 0;  ///< adding the shift back, refinement, Lucas–Kanade step, rejection beside the road
  double roll = 0;        ///< roll and projection model
  double transform = 0;   ///< disparity transformation
  double download = 0;    ///< maps from a device to the host; about 0 with the engines of the host
  double total = 0;       ///< on the host's clock; so are the other stages, unless DeviceOptions::timing is set
};

/// Result for one pair. All maps have the size of the images.
struct FrameResult {
  GreyImage grey;            ///< the left image; deblocked and smoothed by `smoothed_px2`, as is the right one
  GreyImage right;           ///< the right image; misaligned by `shift.misalignment`
  Image<float> disparity;    ///< ℓ: left-image disparities, pixels, NaN invalid
  Image<float> sigma;        ///< standard error of `disparity`, pixels, NaN where that is invalid
  int smoothing_px = 0;      ///< RefinementOptions::smoothing_px, which `sigma` was computed with
  Image<std::uint8_t> mask;  ///< of `Pipeline::set_mask`, not 0 where pixels are left out; empty without one
  Image<float> transformed;  ///< ℓ': the intact road lies at `delta_t`, damage below, bumps above; NaN invalid
  RoadModelEstimate road;    ///< before matching
  PerspectiveShift shift;
  RollEstimate geometry;    ///< after matching; valid only when `roll_found`
  bool roll_found = false;  ///< false without a road, with too few valid disparities, or if the plane is tilted like a
                            ///< wall; `transformed` is then all NaN
  double delta_t = 0;       ///< δt, pixels
  RoadResiduals spread;     ///< σ_d, eq. (37)
  double valid_share = 0;   ///< share of the pixels that have a disparity
  /// Excess of the steps between blocks of 8×8 pixels (JPEG) over those beside them, relative, of the left and the
  /// right image before `deblock`; NaN if not measured.
  std::array<double, 2> block_steps{std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};
  RowAlignment rows;        ///< `points` is 0 if it was not measured for this frame (PipelineOptions::check_rows)
  BlurDifference blur;      ///< `windows` is 0 if it was not measured for this frame (PipelineOptions::equalise_blur)
  double smoothed_px2 = 0;  ///< variance of the Gaussian with which one image was smoothed, pixels²: the left one if it
                            ///< is positive, the right one if it is negative, neither if it is 0
  StageTimes ms;
  double mde_per_s = 0;  ///< millions of disparity evaluations per second: W·H·D / total time
  std::vector<std::string> warnings;
  std::optional<RigBias> rig_bias;  ///< error field that was subtracted from `disparity`
};

/// State carried from one frame to the next. A run restored from it, with the same options, mask and white level, gives
/// bit-identical results. A frame of another size resets it.
struct PipelineState {
  int width = 0;                    ///< size of the frames, pixels; 0 before the first one
  int height = 0;                   ///< pixels
  std::optional<TrackedRoad> road;  ///< the last frame's road; absent when it had none
  double roll_rad = 0;              ///< ψ(t), start of the descent of ψ(t+1), eq. (25); 0 when not observable
  Misalignment misalignment;        ///< of the target, as last measured; zero where it is none, or unknown
  bool rows_known = false;          ///< whether `misalignment` was measured
  int frames_since_rows = 0;        ///< frames since the last attempt to measure the rows
  double blur_px2 = 0;              ///< BlurDifference::variance_px2 that is equalised; 0: none
  int frames_since_blur = 0;        ///< frames since the last attempt to measure it

  /// Throws Error naming the first value that is out of range for frames of this size.
  void validate() const;
};

/// Runs section 3 of the paper on successive stereo pairs. Keeps the state and the scratch memory between frames. Not
/// thread-safe; distinct instances are independent.
class Pipeline {
 public:
  /// Throws Error when an option is out of range, the engine does not exist, or a height or pitch is expected without
  /// a calibration.
  explicit Pipeline(const PipelineOptions& options = preset("default"),
                    const std::optional<StereoCalibration>& calibration = std::nullopt);
  ~Pipeline();
  Pipeline(Pipeline&&) noexcept;
  Pipeline& operator=(Pipeline&&) noexcept;

  /// Processes one rectified pair. The result belongs to the pipeline and is valid until the next call.
  /// Throws Error for an invalid pair: sizes differ or are outside 32×32 … 8192×8192, an image has one colour, both
  /// images are the same, left and right seem to be swapped, the white level is above 255 and samples have 8 bits, the
  /// calibration, the mask or the rig bias belongs to another size or rig, or `perspective.delta_p_px` is not less than
  /// the number of disparities in images of this width.
  const FrameResult& process(const FrameView& left, const FrameView& right);

  /// The same, but swaps the result with `result` and reuses its memory: with two or more results in turn, one frame
  /// can be read while the next one is processed.
  void process(const FrameView& left, const FrameView& right, FrameResult& result);

  /// Finds and measures damage in the last frame. Without a road, the result is empty. Throws Error when there is no
  /// last frame (none yet, rejected, swapped out, reset, or `restore` called since, `set_device_options`, or `set_mask`
  /// where it changes the engine), or when hardly any of its disparities lies on a road.
  DamageMap find_damage() const;
  /// The same into an earlier result, whose maps keep their memory when the sizes are equal.
  void find_damage(DamageMap& result) const;

  /// Returns the state that the next frame starts from.
  const PipelineState& carried() const;

  /// Makes the next frame start from `carried`. Throws Error when its `validate` does.
  void restore(const PipelineState& carried);

  /// Allocates memory and starts threads for frames of this size, so that the first frame takes no longer than later
  /// ones. Resets the pipeline. Throws Error for a size that `process` rejects.
  void warm_up(int width, int height);

  /// Makes the next frame start without state.
  void reset();

  /// Leaves out pixels of the left image where `mask` (W×H) is not 0, such as those of a bonnet: they take no part in
  /// finding the road, and have neither disparity nor damage. It holds for all later frames; one without set pixels
  /// ends it. The engine cuda takes none: `auto` becomes cpu, and Error is thrown if cuda or set_device_options was
  /// asked for. `process` throws it when the sizes differ.
  void set_mask(ImageView<const std::uint8_t> mask);

  /// Sets PipelineOptions::white_level from the next frame on. Throws Error outside 0 … 65535.
  void set_white_level(double level);

  /// Engine cuda: shares a device with the caller (roadstereo/device.hpp), from the next frame on. Frames may also lie
  /// in device memory. Throws Error for any other engine.
  void set_device_options(const DeviceOptions& use);
  /// Engine cuda: returns the last frame's maps in device memory. Throws Error for any other engine, or without a
  /// frame.
  DeviceMaps device_maps() const;
  /// Engine cuda with DeviceTiming::kernels: returns the last frame's kernels with their times, launches, waits and
  /// copies. Throws Error for any other engine or timing, or without a frame.
  DeviceProfile device_profile() const;

  const PipelineOptions& options() const;
  const std::optional<StereoCalibration>& calibration() const;
  const std::string& engine_name() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Finds damage in a result that was swapped out, as `Pipeline::find_damage` does. Damages at the edge of a mask are
/// measured including the part that is interpolated under it; a damage with half or more of its pixels under the mask
/// is dropped. Throws Error if `frame` has no maps on the host, and as find_damage(DamageInput).
DamageMap find_damage(const FrameResult& frame, const std::optional<StereoCalibration>& calibration,
                      const DamageOptions& options = {}, int threads = 0);
/// The same into an earlier result, whose maps keep their memory when the sizes are equal.
void find_damage(const FrameResult& frame, const std::optional<StereoCalibration>& calibration,
                 const DamageOptions& options, int threads, DamageMap& result);

}  // namespace roadstereo
#pragma GCC visibility pop
