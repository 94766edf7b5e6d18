#pragma once

#include <memory>
#include <optional>

#include "roadstereo/pipeline.hpp"

namespace roadstereo {

struct DeviceOptions;
struct DeviceMaps;

/// Two grey images on the host.
struct GreyPair {
  ImageView<const std::int16_t> left, right;
};

/// The work on a frame, stage by stage in the order of the paper's section 3. `Pipeline` decides, the stages compute:
/// on the host, or all of them in a device's memory. `result` is the frame's; a stage reads what earlier ones put
/// there, and what it says it fills may be filled as late as in `deliver`.
class FrameStages {
 public:
  virtual ~FrameStages() = default;

  /// Converts both images to grey, fills result.grey. Refuses images without a picture and a pair of equal ones.
  virtual void prepare(const FrameView& left, const FrameView& right, FrameResult& result) = 0;
  /// Both grey images on the host, for what is done once in a while.
  virtual GreyPair grey(FrameResult& result) = 0;
  /// verify_road_model.
  virtual RoadModelEstimate verify_road(const TrackedRoad& previous, const FrameResult& result) = 0;
  /// transform_target by result.shift, π_tar → π_tar'.
  virtual void transform_perspective(const FrameResult& result) = 0;
  /// Which disparities each tile can have, and a coarse map that matching leans on where the costs leave a choice.
  virtual void search_coarsely(const FrameResult& result) = 0;
  /// Section 3.2.
  virtual void match(const MatcherOptions& options, const FrameResult& result) = 0;
  /// Adds the shift back, and smooths where the standard errors allow it: fills disparity and sigma.
  virtual void refine(FrameResult& result) = 0;
  /// Fills valid_share, the share of the pixels that have a disparity, and, where that is at least `min_share`,
  /// geometry (estimate_roll). False where it is not.
  virtual bool fit_geometry(const std::optional<DisparityPlane>& prior, double initial_roll_rad, double min_share,
                            FrameResult& result) = 0;
  /// ℓ → ℓ' by result.geometry: fills transformed, delta_t and spread.
  virtual void transform(FrameResult& result) = 0;
  /// Fills transformed with NaN: no road was found.
  virtual void invalidate_transformed(FrameResult& result) = 0;
  /// Fills whatever is still on its way, and the times of the stages where it knows them better than a clock on the
  /// host.
  virtual void deliver(FrameResult& result) = 0;

  /// Where a device's maps go, and where they are (roadstereo/device.hpp). Throw Error where there is no device.
  virtual void set_device_options(const DeviceOptions& use) = 0;
  virtual DeviceMaps device_maps() const = 0;
};

}  // namespace roadstereo
