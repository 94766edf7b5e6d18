#pragma once

#include <cstdint>
#include <optional>

#include "roadstereo/cell_levels.hpp"
#include "roadstereo/disparity_plane.hpp"
#include "roadstereo/image.hpp"

#pragma GCC visibility push(default)
namespace roadstereo {

struct StaticMaskOptions {
  int frames = 40;                   ///< that must have moved before it is judged what never moves, 10 … 100
  double max_variance_ratio = 0.25;  ///< of the levels over the frames, by the square of their gradients, 0.001 … 1
  int margin_px = 10;                ///< by which the mask is grown: half the matching window, 0 … 100

  /// Throws Error naming the first option that is out of range.
  void validate() const;
};

/// Watches a recording for what never moves in the picture while the rest does: a bonnet, a landing gear, a mount. It
/// judges once. What is still shows a texture in two directions (structure tensor) that the mean over the frames keeps,
/// varies no more than noise does, and reaches in from the border of the picture. So neither a road without texture is
/// still, nor a line along it, nor the point that the vehicle drives to; and nothing is while the vehicle stands.
class StaticMask {
 public:
  /// Throws Error when an option is out of range.
  explicit StaticMask(const StaticMaskOptions& options = {});

  /// Adds the next pair of a recording, by its grey levels. With `road`, its plane, only what lies below the horizon is
  /// masked, and what hides the road from the right camera, too. Returns whether this pair was the one that judged.
  /// Does nothing after that. Allocates only for the first frame, and after half of the frames and all of them.
  bool add(ImageView<const std::int16_t> left, ImageView<const std::int16_t> right,
           const std::optional<DisparityPlane>& road);

  /// Whether enough frames have moved.
  bool judged() const { return judged_; }

  /// What never moves, W×H of the left image, for Pipeline::set_mask: 255 there, else 0. Empty: nothing, or not judged.
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
