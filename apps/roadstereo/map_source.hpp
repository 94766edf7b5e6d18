#pragma once

#include <optional>
#include <string>
#include <vector>

#include "roadstereo/calibration.hpp"
#include "roadstereo/image.hpp"
#include "roadstereo/road_model.hpp"

namespace roadstereo::cli {

/// Input files of `damage`; empty: absent.
struct MapFiles {
  std::string transformed;
  std::string image;
  std::string disparity;
  std::vector<std::string> calibration;  ///< empty, one file, or two: left and right
};

/// A transformed map and its optional context.
struct TransformedMap {
  Image<float> transformed;    ///< px if there is a disparity map, else of any scale
  std::optional<Frame> image;  ///< left image
  std::optional<Image<float>> disparity;
  std::optional<DisparityPlane> plane;  ///< road model in `disparity`
  std::optional<StereoCalibration> calibration;
};

/// Reads the files. With a disparity map the scale of the transformed map, unknown in 16-bit PNG, is estimated by
/// `threads` workers; 0 takes all cores. Throws Error naming the file if it is unreadable, of another size, of another
/// scene, or 8-bit.
TransformedMap read_transformed_map(const MapFiles& files, int threads = 0);

}  // namespace roadstereo::cli
