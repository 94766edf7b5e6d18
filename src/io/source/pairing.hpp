#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/source/image_pairs.hpp"

namespace roadstereo::io {

/// An image of one camera.
struct ViewFile {
  std::string path;
  std::string stem;              ///< file name without extension
  std::string key;               ///< what both views of a pair have in common
  std::optional<double> time_s;  ///< as its name tells
};

/// Orders names as people count: "frame2" before "frame10".
bool natural_less(const std::string& one, const std::string& other);

/// Pairs the images of equal key; where both cameras name their images by the time, those nearest in time. What has no
/// partner, or one that is further away than `max_time_difference_s`, is refused.
std::vector<ImagePair> pair_views(std::vector<ViewFile> left, std::vector<ViewFile> right,
                                  double max_time_difference_s);

}  // namespace roadstereo::io
