#include "io/ros/flight_messages.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "io/frame_mat.hpp"
#include "io/ros/definitions.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/ground_plane.hpp"
#include "roadstereo/io/jpeg.hpp"

namespace roadstereo::io {
namespace {

// Positions in the list of topics.
enum : std::uint16_t { left_image, disparity, left_info, points, damages, tf, odometry };

constexpr const char* camera = "left_camera_optical";

std::uint64_t nanoseconds(double time_s) {
  constexpr double last_s = 2147483647;  // of builtin_interfaces/Time
  if (!(time_s >= 0 && time_s <= last_s)) {
    fail("a frame has the time ", time_s, " s; a ROS message can have 0 … ", last_s, " s");
  }
  return static_cast<std::uint64_t>(std::llround(1e9 * time_s));
}

std::vector<std::uint8_t> jpeg_of(const FrameView& left, double white_level) {
  constexpr int quality = 90;
  if (left.sample == SampleType::u8) return encode_jpeg(left, quality, left.width);
  return encode_jpeg(frame_from(to_bgr(left, white_level), ChannelOrder::bgr).view(), quality, left.width);
}

/// From the road to the camera: the axes are the columns.
std::array<double, 12> matrix_of(const RoadAxes& road) {
  std::array<double, 12> matrix{};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::array<double, 4> row{road.x[i], road.y[i], road.z[i], road.origin_m[i]};
    std::copy(row.begin(), row.end(), matrix.begin() + static_cast<std::ptrdiff_t>(4 * i));
  }
  return matrix;
}

std::vector<RosTransform> transforms_of(const RosFrame& frame, const std::optional<RoadAxes>& road,
                                        std::uint64_t time_ns) {
  std::vector<RosTransform> all;
  if (frame.pose) all.push_back({{time_ns, "odom"}, camera, frame.pose->camera_to_odom});
  if (road) all.push_back({{time_ns, camera}, "road", matrix_of(*road)});
  return all;
}

double camera_height_m(const std::optional<RoadAxes>& road) {
  return road ? std::hypot(road->origin_m[0], road->origin_m[1], road->origin_m[2]) : 1;
}

}  // namespace

std::vector<RosTopic> flight_topics(bool calibrated, bool with_odometry) {
  namespace text = ros_definitions;
  std::vector<RosTopic> topics{
      {"/roadstereo/left/image_rect/compressed", "sensor_msgs/msg/CompressedImage", text::image},
      {"/roadstereo/disparity", "stereo_msgs/msg/DisparityImage", text::disparity_image},
      {"/roadstereo/left/camera_info", "sensor_msgs/msg/CameraInfo", text::camera_info},
      {"/roadstereo/points", "sensor_msgs/msg/PointCloud2", text::point_cloud},
      {"/roadstereo/damages", "visualization_msgs/msg/MarkerArray", text::marker_array},
      {"/tf", "tf2_msgs/msg/TFMessage", text::transforms},
      {"/roadstereo/odometry", "nav_msgs/msg/Odometry", text::odometry},
  };
  if (!with_odometry) topics.pop_back();
  if (!calibrated) topics.resize(left_info);
  return topics;
}

std::vector<TopicMessage> flight_messages(const RosFrame& frame) {
  const std::uint64_t time_ns = nanoseconds(frame.time_s);
  const RosHeader of_camera{time_ns, camera}, of_road{time_ns, "road"};
  std::vector<TopicMessage> messages;
  const auto add = [&](std::uint16_t topic, RosMessage message) {
    messages.push_back({topic, frame.sequence, time_ns, std::move(message)});
  };
  add(left_image, compressed_image(of_camera, jpeg_of(frame.left, frame.white_level)));
  add(disparity, disparity_image(of_camera, frame.maps.disparity, frame.calibration));
  if (frame.calibration == nullptr) return messages;
  add(left_info, camera_info(of_camera, *frame.calibration, frame.left.width, frame.left.height));
  add(points, point_cloud(of_camera, frame.maps, *frame.calibration));
  std::optional<RoadAxes> road;
  if (frame.road) road = road_axes(ground_plane(*frame.road, *frame.calibration));
  add(damages, damage_markers(of_road, frame.damages, camera_height_m(road)));
  const std::vector<RosTransform> moved = transforms_of(frame, road, time_ns);
  if (!moved.empty()) add(tf, transforms(moved));
  if (frame.pose) {
    const RosTransform pose{{time_ns, "odom"}, camera, frame.pose->camera_to_odom};
    add(odometry, odometry_message(pose, frame.pose->covariance));
  }
  return messages;
}

}  // namespace roadstereo::io
