#pragma once

#include <array>
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
/// levels, disparities in 1/64 px and their standard errors in 1/128 px.
class KeyframeStore {
 public:
  explicit KeyframeStore(std::filesystem::path folder);
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

  std::filesystem::path folder_;
  int halvings_ = 0;
  int width_ = 0, height_ = 0;  ///< of the maps
};

}  // namespace roadstereo
