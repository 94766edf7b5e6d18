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
  std::string key;               ///< equal for both views of a pair
  std::optional<double> time_s;  ///< parsed from the name
};

/// Natural order of names: "frame2" before "frame10".
bool natural_less(const std::string& one, const std::string& other);

/// Whether all images are named by time.
bool named_by_time(const std::vector<ViewFile>& views);

/// Pairs images with equal keys, or nearest in time if both cameras name their images by time. Unpaired images and
/// pairs farther apart than `max_time_difference_s` have `error` set.
std::vector<ImagePair> pair_views(std::vector<ViewFile> left, std::vector<ViewFile> right,
                                  double max_time_difference_s);

}  // namespace roadstereo::io
