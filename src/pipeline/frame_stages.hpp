#pragma once

#include <memory>
#include <optional>

#include "roadstereo/pipeline.hpp"

namespace roadstereo {

struct DeviceOptions;
struct DeviceMaps;
struct DeviceProfile;

// Values that stages hand on. Their views lie in the memory of the stages, the host's or a device's, and are valid
// until the next frame.

struct GreyPair {
  ImageView<const std::int16_t> left, right;
  ImageView<const std::uint8_t> mask{};  ///< of the left image, not 0 masked; empty: none
};

/// Residual disparities: of the left image and the transformed right one. NaN invalid.
struct ResidualMaps {
  ImageView<float> disparity, variance;
  double samples = 0;  ///< effective samples of one disparity
  int pixel_step = 1;  ///< pixel (x, y) of the maps is pixel_step·(x, y) of the image
};

/// Disparities of the original images, with their variances from matching (pixels²). NaN invalid.
struct DisparityMaps {
  ImageView<const float> disparity, variance;
  double samples = 0;  ///< effective samples of one disparity
  int pixel_step = 1;  ///< likewise
};

/// Refined disparities and their standard errors, pixels. NaN invalid.
struct RefinedMaps {
  ImageView<const float> disparity, sigma;
  int pixel_step = 1;  ///< likewise
};

/// The same of every pixel.
struct InterpolatedMaps {
  ImageView<float> disparity, sigma;
};

/// Section 3.3.1 on one disparity map.
struct RollFit {
  double valid_share = 0;                ///< share of the pixels that have a disparity
  std::optional<RollEstimate> geometry;  ///< empty when that is too small, or they determine none
};

/// What the disparity transformation tells of the map.
struct TransformedRoad {
  double delta_t = 0;    ///< δt, pixels
  RoadResiduals spread;  ///< σ_d
};

/// The work on a frame, stage by stage as in section 3 of the paper: `Pipeline` decides, the stages compute, all of
/// them on the host or all of them on a device. The maps of FrameResult stay with the stages until `download`.
class FrameStages {
 public:
  virtual ~FrameStages() = default;

  /// Converts both images to grey (to_grey). Throws Error for images of one grey level and for two equal images; a
  /// device throws it when the host next waits.
  virtual GreyPair convert_to_grey(const FrameView& left, const FrameView& right, double white_level) = 0;
  /// The pair in host memory.
  virtual GreyPair on_host(const GreyPair& pair) = 0;
  /// Smooths the left image of the pair in place, with a Gaussian of that variance, or the right one if it is negative.
  virtual GreyPair smooth(const GreyPair& pair, double variance_px2) = 0;
  /// transform_target without a road: the pair without the target's misalignment, valid until `transform_perspective`.
  virtual GreyPair undo_misalignment(const GreyPair& pair, const Misalignment& misalignment) = 0;
  /// verify_road_model.
  virtual RoadModelEstimate verify_road_model(const GreyPair& pair, const TrackedRoad& previous) = 0;
  /// transform_target, π_tar → π_tar': returns the pair to match, without search ranges and prior.
  virtual MatchInput transform_perspective(const GreyPair& pair, const PerspectiveShift& shift) = 0;
  /// CoarseSearch: returns `pair` with search ranges and prior.
  virtual MatchInput search_coarsely(const MatchInput& pair, const PerspectiveShift& shift,
                                     const CoarseSearchOptions& options) = 0;
  /// CoarseSearch for all that the pair shows: returns the disparities, empty where the images are too small.
  virtual DisparityPriorView search_scene(const MatchInput& pair, const PerspectiveShift& shift,
                                          const CoarseSearchOptions& options) = 0;
  /// Section 3.2: cost, aggregation, winner-take-all, left-right check, sub-pixel disparity.
  virtual ResidualMaps match(const MatchInput& input, const MatcherOptions& options) = 0;
  /// restore_disparity: adds Δu − δp back.
  virtual DisparityMaps restore_disparity(const ResidualMaps& residual, const PerspectiveShift& shift) = 0;
  /// refine_disparities.
  virtual RefinedMaps refine(const DisparityMaps& maps, const DisparityPlane& road) = 0;
  /// interpolate_disparities, where not every pixel was matched.
  virtual InterpolatedMaps interpolate(const RefinedMaps& maps, const DisparityPlane& road) = 0;
  /// lucas_kanade; `mask` of the left image, not 0 masked, or empty.
  virtual ImageView<const float> align(const MatchInput& input, ImageView<const float> disparity,
                                       const PerspectiveShift& shift, ImageView<const std::uint8_t> mask) = 0;
  /// reject_off_road; the step before must have run.
  virtual ImageView<const float> reject_off_road(ImageView<const float> disparity, const DisparityPriorView& scene,
                                                 const PerspectiveShift& shift, const OffRoadOptions& options,
                                                 ImageView<const std::uint8_t> mask) = 0;
  /// Subtracts the bias of the rig, if any: returns the disparity map ℓ.
  virtual ImageView<const float> subtract_bias(ImageView<const float> disparity,
                                               const std::optional<RigBias>& bias) = 0;
  /// estimate_roll, when there is a road, `prior`, and at least `min_share` of the pixels have a disparity. A device
  /// goes on with the transformation, for which it takes `shift`.
  virtual RollFit estimate_roll(ImageView<const float> disparity, const std::optional<DisparityPlane>& prior,
                                double initial_roll_rad, double min_share, const PerspectiveShift& shift) = 0;
  /// transform_disparity, ℓ → ℓ', and measure_residuals.
  virtual TransformedRoad transform_disparity(ImageView<const float> disparity, const RollEstimate& geometry,
                                              const PerspectiveShift& shift) = 0;
  /// Fills ℓ' with NaN: no road was found.
  virtual void invalidate_transformed() = 0;
  /// Hands over grey, disparity, sigma and transformed, and the times of the stages that a device has measured.
  virtual void download(FrameResult& result) = 0;

  /// Options and results of a device (roadstereo/device.hpp). Throw Error without a device.
  virtual void set_device_options(const DeviceOptions& use) = 0;
  virtual DeviceMaps device_maps() = 0;
  virtual DeviceProfile device_profile() const = 0;
  /// Cleans up after an exception: a device waits for all enqueued work.
  virtual void abandon() noexcept {}
};

}  // namespace roadstereo
