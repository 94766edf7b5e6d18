#include "io/ros/messages.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "io/quaternion.hpp"
#include "io/ros/cdr_writer.hpp"
#include "io/ros/header.hpp"
#include "roadstereo/point_cloud.hpp"

namespace roadstereo::io {
namespace {

/// sensor_msgs/RegionOfInterest
void add_region(int width, int height, CdrWriter& cdr) {
  cdr.add(std::uint32_t{0}).add(std::uint32_t{0});
  cdr.add(static_cast<std::uint32_t>(height)).add(static_cast<std::uint32_t>(width)).add(false);
}

/// Position, or translation, and rotation.
void add_pose(const std::array<double, 12>& m, CdrWriter& cdr) {
  cdr.add(m[3]).add(m[7]).add(m[11]).add_each(quaternion(m));
}

/// sensor_msgs/PointField of a float32.
void add_field(std::string_view name, std::uint32_t offset, CdrWriter& cdr) {
  constexpr std::uint8_t float32 = 7;
  cdr.text(name).add(offset).add(float32).add(std::uint32_t{1});
}

template <class Value>
std::span<const std::uint8_t> bytes_of(const std::vector<Value>& values) {
  return {reinterpret_cast<const std::uint8_t*>(values.data()), values.size() * sizeof(Value)};
}

}  // namespace

RosMessage compressed_image(const RosHeader& header, std::span<const std::uint8_t> jpeg) {
  CdrWriter cdr;
  add_header(header, cdr);
  return cdr.text("jpeg").data(jpeg).take();
}

RosMessage camera_info(const RosHeader& header, const StereoCalibration& calibration, int width, int height) {
  const double f = calibration.focal_px, cx = calibration.cx_px, cy = calibration.cy_px;
  CdrWriter cdr;
  add_header(header, cdr);
  cdr.add(static_cast<std::uint32_t>(height)).add(static_cast<std::uint32_t>(width)).text("plumb_bob");
  cdr.count(5).add_each(std::array<double, 5>{});
  cdr.add_each(std::array{f, 0., cx, 0., f, cy, 0., 0., 1.});
  cdr.add_each(std::array{1., 0., 0., 0., 1., 0., 0., 0., 1.});
  cdr.add_each(std::array{f, 0., cx, 0., 0., f, cy, 0., 0., 0., 1., 0.});
  cdr.add(std::uint32_t{0}).add(std::uint32_t{0});  // no binning
  add_region(0, 0, cdr);                            // the whole image
  return cdr.take();
}

RosMessage disparity_image(const RosHeader& header, ImageView<const float> disparity,
                           const StereoCalibration* calibration) {
  const int width = disparity.width(), height = disparity.height();
  const auto offset = static_cast<float>(calibration != nullptr ? calibration->disparity_offset_px : 0);
  float least = std::numeric_limits<float>::infinity(), most = -least;
  std::vector<float> values;
  values.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      values.push_back(disparity(u, v) + offset);
      if (!std::isfinite(values.back())) continue;
      least = std::min(least, values.back());
      most = std::max(most, values.back());
    }
  }
  CdrWriter cdr;
  add_header(header, cdr);
  add_header(header, cdr);  // of the image
  cdr.add(static_cast<std::uint32_t>(height)).add(static_cast<std::uint32_t>(width)).text("32FC1");
  cdr.add(std::uint8_t{0}).add(static_cast<std::uint32_t>(sizeof(float)) * static_cast<std::uint32_t>(width));
  cdr.data(bytes_of(values));
  cdr.add(static_cast<float>(calibration != nullptr ? calibration->focal_px : 0));
  cdr.add(static_cast<float>(calibration != nullptr ? calibration->baseline_m : 0));
  add_region(width, height, cdr);
  cdr.add(least <= most ? least : 0.F).add(least <= most ? most : 0.F);
  return cdr.add(0.F).take();  // disparities have no steps
}

RosMessage point_cloud(const RosHeader& header, const RosPoints& maps, const StereoCalibration& calibration) {
  constexpr std::array names{"x", "y", "z", "sigma", "intensity"};
  constexpr auto point_bytes = static_cast<std::uint32_t>(names.size() * sizeof(float));
  std::vector<float> values;
  values.reserve(names.size() * static_cast<std::size_t>(maps.disparity.width()) *
                 static_cast<std::size_t>(maps.disparity.height()));
  for (int v = 0; v < maps.disparity.height(); ++v) {
    for (int u = 0; u < maps.disparity.width(); ++u) {
      const double d = maps.disparity(u, v);
      if (!std::isfinite(d) || d + calibration.disparity_offset_px < min_cloud_disparity_px) continue;
      const std::array<double, 3> point = calibration.point_m(u, v, d);
      const double z_per_px = point[2] / (d + calibration.disparity_offset_px);
      constexpr double sixteenths = 16;
      for (const double value :
           {point[0], point[1], point[2], z_per_px * maps.sigma(u, v), maps.grey(u, v) / sixteenths})
        values.push_back(static_cast<float>(value));
    }
  }
  const auto points = static_cast<std::uint32_t>(values.size() / names.size());
  CdrWriter cdr;
  add_header(header, cdr);
  cdr.add(std::uint32_t{1}).add(points);
  cdr.count(names.size());
  for (std::uint32_t i = 0; i < names.size(); ++i) {
    add_field(names[i], i * static_cast<std::uint32_t>(sizeof(float)), cdr);
  }
  cdr.add(false).add(point_bytes).add(point_bytes * points);
  return cdr.data(bytes_of(values)).add(true).take();
}

RosMessage odometry_message(const RosTransform& pose, const std::array<double, 36>& covariance) {
  CdrWriter cdr;
  add_header(pose.header, cdr);
  cdr.text(pose.child);
  add_pose(pose.child_to_parent, cdr);
  cdr.add_each(covariance);
  std::array<double, 36> unknown{};
  unknown[0] = -1;
  return cdr.add_each(std::array<double, 6>{}).add_each(unknown).take();
}

RosMessage transforms(std::span<const RosTransform> transforms) {
  CdrWriter cdr;
  cdr.count(transforms.size());
  for (const RosTransform& transform : transforms) {
    add_header(transform.header, cdr);
    cdr.text(transform.child);
    add_pose(transform.child_to_parent, cdr);
  }
  return cdr.take();
}

}  // namespace roadstereo::io
