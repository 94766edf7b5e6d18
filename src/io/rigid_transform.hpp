#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace roadstereo::io {

/// Returns the 4×4 matrix of the values, row-major. Throws Error naming `path` and `key` unless its last row is 0 0
/// 0 1.
cv::Matx44d rigid_transform(const std::vector<double>& values, const std::string& path, const std::string& key);

/// Inverts a rotation and translation.
cv::Matx44d inverse(const cv::Matx44d& transform);

}  // namespace roadstereo::io
