#include "io/rigid_transform.hpp"

#include "roadstereo/error.hpp"

namespace roadstereo::io {

cv::Matx44d rigid_transform(const std::vector<double>& values, const std::string& path, const std::string& key) {
  if (values.size() != 16) fail(path, ": ", key, " has ", values.size(), " values; it must have 16");
  if (values[12] != 0 || values[13] != 0 || values[14] != 0 || values[15] != 1) {
    fail(path, ": the last row of ", key, " must be 0 0 0 1");
  }
  return cv::Matx44d(values.data());
}

cv::Matx44d inverse(const cv::Matx44d& transform) {
  const cv::Matx33d rotation = transform.get_minor<3, 3>(0, 0).t();
  const cv::Vec3d translation = -(rotation * cv::Vec3d(transform(0, 3), transform(1, 3), transform(2, 3)));
  cv::Matx44d inverted = cv::Matx44d::eye();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) inverted(i, j) = rotation(i, j);
    inverted(i, 3) = translation[i];
  }
  return inverted;
}

}  // namespace roadstereo::io
