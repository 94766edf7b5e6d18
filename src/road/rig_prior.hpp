#pragma once

#include <optional>
#include <string>

#include "roadstereo/road_model.hpp"

namespace roadstereo {

/// Height and pitch that the user expects of the camera.
class RigPrior {
 public:
  /// Throws Error if something is expected without a calibration.
  RigPrior(const RoadModelOptions& options, const std::optional<StereoCalibration>& calibration);

  /// Whether anything is expected.
  explicit operator bool() const { return height_m_ || pitch_deg_; }

  /// Weight of a plane, above 0 … 1: 1 where it is as expected, ½ where height or pitch is off by its tolerance.
  double weight(const DisparityPlane& plane) const;

  /// Sentence about a plane that is off by more than a tolerance; empty where it is not.
  std::string disagreement(const DisparityPlane& plane) const;

 private:
  std::optional<double> height_m_, pitch_deg_;
  std::optional<StereoCalibration> calibration_;
};

}  // namespace roadstereo
