#pragma once

#include <optional>
#include <string>
#include <vector>

#include "roadstereo/calibration.hpp"
#include "roadstereo/image.hpp"
#include "roadstereo/road_model.hpp"

namespace roadstereo::cli {

/// Files that `damage` starts from; empty ones are not given.
struct MapFiles {
  std::string transformed;
  std::string image;
  std::string disparity;
  std::vector<std::string> calibration;  ///< none, one file, or the two of a ROS pair
};

/// A transformed map of somebody's, with what else is known.
struct TransformedMap {
  Image<float> transformed;    ///< pixels when the disparity map is there, else of any scale
  std::optional<Frame> image;  ///< left image
  std::optional<Image<float>> disparity;
  std::optional<DisparityPlane> plane;  ///< of the road in `disparity`
  std::optional<StereoCalibration> calibration;
};

/// Reads the files. With a disparity map the scale of the transformed map, which 16-bit PNG does not tell, follows from
/// both. Throws Error naming the file: unreadable, of another size, of another scene, or 8-bit.
TransformedMap read_transformed_map(const MapFiles& files);

}  // namespace roadstereo::cli
