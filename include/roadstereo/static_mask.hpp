#pragma once

#include <cstdint>
#include <optional>

#include "roadstereo/cell_levels.hpp"
#include "roadstereo/disparity_plane.hpp"
#include "roadstereo/image.hpp"

#pragma GCC visibility push(default)
namespace roadstereo {

struct StaticMaskOptions {
  int frames = 40;  ///< frames in which the image has moved that are needed for the decision, 10 … 100
  double max_variance_ratio = 0.25;  ///< variance of the grey levels over the frames, divided by their squared
                                     ///< gradient, 0.001 … 1
  int margin_px = 10;                ///< margin by which the mask is grown, half the matching window, 0 … 100

  /// Throws Error naming the first option that is out of range.
  void validate() const;
};

/// Finds parts of the image that never move in a recording while the rest does: a bonnet, a landing gear, a mount. The
/// decision is made once. A still part has texture in two directions (structure tensor) that remains in the mean over
/// the frames, varies no more than the noise, and touches the border of the image. This excludes a road without
/// texture, a line along the road and the point towards which the vehicle drives; and no decision is made while the
/// vehicle is at a standstill.
class StaticMask {
 public:
  /// Throws Error when an option is out of range.
  explicit StaticMask(const StaticMaskOptions& options = {});

  /// Adds the next pair of a recording, by its grey levels. With `road`, the plane of the road, only parts below the
  /// horizon are masked, and in addition pixels whose road is hidden from the right camera. The horizon is where the
  /// plane has the disparity `at_infinity_px`, which is −StereoCalibration::disparity_offset_px. Returns whether the
  /// decision was made with this pair. Does nothing after that. Allocates only for the first frame, and after half of
  /// the frames and all of them. Throws Error when the sizes of the images differ.
  bool add(ImageView<const std::int16_t> left, ImageView<const std::int16_t> right,
           const std::optional<DisparityPlane>& road, double at_infinity_px = 0);

  /// Whether the decision has been made.
  bool judged() const { return judged_; }

  /// Mask of the parts that never move, W×H of the left image, for Pipeline::set_mask: 255 there, else 0. Empty: there
  /// are none, or no decision was made yet.
  const Image<std::uint8_t>& mask() const { return mask_; }

  /// Share of the picture that the mask covers, 0 … 1.
  double share() const;

 private:
  StaticMaskOptions options_;
  CellLevels left_, right_;
  bool has_half_ = false;  ///< the first half of the frames has moved
  bool judged_ = false;
  Image<std::uint8_t> mask_;
};

}  // namespace roadstereo
#pragma GCC visibility pop
