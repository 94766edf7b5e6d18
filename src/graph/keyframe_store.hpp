#pragma once

#include <array>
#include <cmath>
#include <filesystem>
#include <vector>

#include "roadstereo/image.hpp"
#include "roadstereo/odometry.hpp"

namespace roadstereo {

/// Maps of a keyframe, as small as loops need them.
struct KeyframeMaps {
  GreyImage grey;
  Image<float> disparity, sigma;
  DisparityPlane road;

  OdometryFrame view() const { return {grey, disparity, sigma, true, road}; }
};

/// Frames in files of a folder of its own, halved until they have at most 640 × 480 pixels: five bytes a pixel, grey
/// levels, disparities with their offset in 1/64 px and standard errors in 1/128 px.
class KeyframeStore {
 public:
  /// `disparity_offset_px`: of the calibration.
  KeyframeStore(std::filesystem::path folder, double disparity_offset_px);
  ~KeyframeStore();
  KeyframeStore(const KeyframeStore&) = delete;
  KeyframeStore& operator=(const KeyframeStore&) = delete;

  /// Throws SystemError on a full disk.
  void write(int frame, const OdometryFrame& maps);
  KeyframeMaps read(int frame) const;

  /// The calibration of the maps of frames that have the size of the last one written.
  StereoCalibration calibration(const StereoCalibration& full) const;

 private:
  std::filesystem::path file(int frame) const { return folder_ / std::to_string(frame); }

  /// Added to disparities: what is not positive then has no depth.
  float offset_px() const { return static_cast<float>(std::ldexp(disparity_offset_px_, -halvings_)); }

  std::filesystem::path folder_;
  double disparity_offset_px_;
  int halvings_ = 0;
  int width_ = 0, height_ = 0;  ///< of the maps
};

}  // namespace roadstereo
