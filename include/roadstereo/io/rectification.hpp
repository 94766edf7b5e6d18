#pragma once

#include <memory>

#include "roadstereo/calibration.hpp"
#include "roadstereo/image.hpp"
#include "roadstereo/io/calibration_file.hpp"

#pragma GCC visibility push(default)
namespace roadstereo::io {

/// A rectified pair and its calibration. Every pixel has image content (no black borders).
struct RectifiedPair {
  Frame left;
  Frame right;
  StereoCalibration calibration;
};

/// Undistorts and rectifies pairs of one rig. The pixel maps are computed once.
class Rectifier {
 public:
  /// For frames of this size; `threads`: workers, 0 takes all cores. Throws Error if the rig has another size, or if
  /// its right camera is not to the right of the left one (the message names its position).
  Rectifier(const StereoRig& rig, int width, int height, int threads = 0);
  ~Rectifier();
  Rectifier(Rectifier&&) noexcept;
  Rectifier& operator=(Rectifier&&) noexcept;

  /// Calibration of the rectified frames.
  const StereoCalibration& calibration() const;

  /// Rectifies a pair. Throws Error if a frame has another size.
  RectifiedPair rectify(const Frame& left, const Frame& right) const;

 private:
  struct Maps;
  std::unique_ptr<Maps> maps_;
};

/// Rectifies one pair, see Rectifier.
RectifiedPair rectify(const Frame& left, const Frame& right, const StereoRig& rig, int threads = 0);

}  // namespace roadstereo::io
#pragma GCC visibility pop
