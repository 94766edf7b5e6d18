#pragma once

#include <memory>

#include "roadstereo/calibration.hpp"
#include "roadstereo/image.hpp"
#include "roadstereo/io/calibration_file.hpp"

namespace roadstereo::io {

/// A rectified pair and the rectified rig it belongs to. Every pixel has image content (no black borders).
struct RectifiedPair {
  Frame left;
  Frame right;
  StereoCalibration calibration;
};

/// Undistorts pairs of one rig and makes their rows agree; where each pixel comes from is worked out once.
class Rectifier {
 public:
  /// For frames of this size. Throws Error when that is not the rig's size, or the rig cannot be rectified sideways
  /// (right camera above, below or left of the left one: the sentence says which).
  Rectifier(const StereoRig& rig, int width, int height);
  ~Rectifier();
  Rectifier(Rectifier&&) noexcept;
  Rectifier& operator=(Rectifier&&) noexcept;

  /// Of the rectified frames.
  const StereoCalibration& calibration() const;

  /// Throws Error when a frame does not have the size.
  RectifiedPair rectify(const Frame& left, const Frame& right) const;

 private:
  struct Maps;
  std::unique_ptr<Maps> maps_;
};

/// One pair, see Rectifier.
RectifiedPair rectify(const Frame& left, const Frame& right, const StereoRig& rig);

}  // namespace roadstereo::io
