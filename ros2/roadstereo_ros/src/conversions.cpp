#include "conversions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <roadstereo/error.hpp>
#include <roadstereo/ground_plane.hpp>
#include <roadstereo/point_cloud.hpp>
#include <sensor_msgs/msg/point_field.hpp>
#include <string>
#include <vector>

namespace roadstereo_ros {
namespace {

struct Encoding {
  const char* name;
  roadstereo::SampleType sample;
  roadstereo::ChannelOrder order;
};

constexpr std::array<Encoding, 12> encodings{{
    {"mono8", roadstereo::SampleType::u8, roadstereo::ChannelOrder::grey},
    {"8UC1", roadstereo::SampleType::u8, roadstereo::ChannelOrder::grey},
    {"mono16", roadstereo::SampleType::u16, roadstereo::ChannelOrder::grey},
    {"16UC1", roadstereo::SampleType::u16, roadstereo::ChannelOrder::grey},
    {"bgr8", roadstereo::SampleType::u8, roadstereo::ChannelOrder::bgr},
    {"rgb8", roadstereo::SampleType::u8, roadstereo::ChannelOrder::rgb},
    {"bgra8", roadstereo::SampleType::u8, roadstereo::ChannelOrder::bgra},
    {"rgba8", roadstereo::SampleType::u8, roadstereo::ChannelOrder::rgba},
    {"bgr16", roadstereo::SampleType::u16, roadstereo::ChannelOrder::bgr},
    {"rgb16", roadstereo::SampleType::u16, roadstereo::ChannelOrder::rgb},
    {"bgra16", roadstereo::SampleType::u16, roadstereo::ChannelOrder::bgra},
    {"rgba16", roadstereo::SampleType::u16, roadstereo::ChannelOrder::rgba},
}};

template <class Value>
void copy_bytes(const std::vector<Value>& values, std::vector<std::uint8_t>& bytes) {
  bytes.resize(values.size() * sizeof(Value));
  if (!bytes.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
}

sensor_msgs::msg::PointField field(const char* name, std::size_t index) {
  sensor_msgs::msg::PointField field;
  field.name = name;
  field.offset = static_cast<std::uint32_t>(index * sizeof(float));
  field.datatype = sensor_msgs::msg::PointField::FLOAT32;
  field.count = 1;
  return field;
}

}  // namespace

roadstereo::FrameView frame_view(const sensor_msgs::msg::Image& image) {
  const auto* const encoding = std::find_if(encodings.begin(), encodings.end(),
                                            [&](const Encoding& known) { return image.encoding == known.name; });
  if (encoding == encodings.end()) roadstereo::fail("images with the encoding ", image.encoding, " are not supported");
  const bool wide = encoding->sample == roadstereo::SampleType::u16;
  const std::size_t row =
      std::size_t{image.width} * static_cast<std::size_t>(channel_count(encoding->order)) * (wide ? 2U : 1U);
  if (image.step < row || image.data.size() < std::size_t{image.step} * image.height) {
    roadstereo::fail("an image of ", image.width, "×", image.height, " pixels has ", image.data.size(),
                     " bytes in rows of ", image.step);
  }
  if (wide && image.is_bigendian != 0) roadstereo::fail("big-endian images are not supported");
  return {image.data.data(),
          static_cast<int>(image.width),
          static_cast<int>(image.height),
          static_cast<std::ptrdiff_t>(image.step),
          encoding->sample,
          encoding->order};
}

roadstereo::StereoCalibration stereo_calibration(const sensor_msgs::msg::CameraInfo& left,
                                                 const sensor_msgs::msg::CameraInfo& right) {
  // P = (f 0 cx Tx; 0 f cy 0; 0 0 1 0), of the right camera Tx = −f·x, x the place of the camera: 0 of most left ones.
  const double f = right.p[0];
  if (!(f > 0) || left.p[0] != f || left.p[5] != f || right.p[5] != f || left.p[6] != right.p[6]) {
    roadstereo::fail("the camera_info are not those of rectified images: P[0] is ", left.p[0], " and ", f, ", P[6] ",
                     left.p[6], " and ", right.p[6]);
  }
  roadstereo::StereoCalibration calibration;
  calibration.focal_px = f;
  calibration.cx_px = left.p[2];
  calibration.cy_px = left.p[6];
  calibration.baseline_m = (left.p[3] - right.p[3]) / f;
  calibration.disparity_offset_px = right.p[2] - left.p[2];
  calibration.width = static_cast<int>(left.width);
  calibration.height = static_cast<int>(left.height);
  calibration.validate(calibration.width, calibration.height, "camera_info");
  return calibration;
}

stereo_msgs::msg::DisparityImage disparity_image(const std_msgs::msg::Header& header,
                                                 const roadstereo::FrameResult& result,
                                                 const roadstereo::StereoCalibration& calibration) {
  const roadstereo::Image<float>& map = result.disparity;
  std::vector<float> values;
  values.reserve(map.pixels());
  float least = std::numeric_limits<float>::infinity(), most = -least;
  for (int v = 0; v < map.height(); ++v) {
    for (int u = 0; u < map.width(); ++u) {
      const float value = map(u, v) + static_cast<float>(calibration.disparity_offset_px);
      values.push_back(value);
      if (!std::isfinite(value)) continue;
      least = std::min(least, value);
      most = std::max(most, value);
    }
  }
  stereo_msgs::msg::DisparityImage message;
  message.header = header;
  message.image.header = header;
  message.image.width = static_cast<std::uint32_t>(map.width());
  message.image.height = static_cast<std::uint32_t>(map.height());
  message.image.encoding = "32FC1";
  message.image.step = message.image.width * static_cast<std::uint32_t>(sizeof(float));
  copy_bytes(values, message.image.data);
  message.f = static_cast<float>(calibration.focal_px);
  message.t = static_cast<float>(calibration.baseline_m);
  message.valid_window.width = message.image.width;
  message.valid_window.height = message.image.height;
  message.min_disparity = least <= most ? least : 0;
  message.max_disparity = least <= most ? most : 0;
  return message;
}

sensor_msgs::msg::PointCloud2 point_cloud(const std_msgs::msg::Header& header, const roadstereo::FrameResult& result,
                                          const roadstereo::StereoCalibration& calibration) {
  constexpr std::array names{"x", "y", "z", "sigma", "intensity"};
  constexpr double sixteenths = 16;           // of a grey level
  std::vector<float> values;
  for (int v = 0; v < result.disparity.height(); ++v) {
    for (int u = 0; u < result.disparity.width(); ++u) {
      const double d = result.disparity(u, v) + calibration.disparity_offset_px;
      if (!std::isfinite(d) || d < roadstereo::min_cloud_disparity_px) continue;
      const std::array<double, 3> point = calibration.point_m(u, v, result.disparity(u, v));
      for (const double coordinate : point) values.push_back(static_cast<float>(coordinate));
      values.push_back(static_cast<float>(point[2] / d * result.sigma(u, v)));
      values.push_back(static_cast<float>(result.grey(u, v) / sixteenths));
    }
  }
  sensor_msgs::msg::PointCloud2 message;
  message.header = header;
  message.height = 1;
  message.width = static_cast<std::uint32_t>(values.size() / names.size());
  for (std::size_t i = 0; i < names.size(); ++i) message.fields.push_back(field(names[i], i));
  message.point_step = static_cast<std::uint32_t>(names.size() * sizeof(float));
  message.row_step = message.point_step * message.width;
  copy_bytes(values, message.data);
  message.is_dense = true;
  return message;
}

visualization_msgs::msg::MarkerArray damage_markers(const std_msgs::msg::Header& header,
                                                    const roadstereo::FrameResult& result,
                                                    const roadstereo::DamageMap& damage,
                                                    const roadstereo::StereoCalibration& calibration) {
  using visualization_msgs::msg::Marker;
  visualization_msgs::msg::MarkerArray message;
  message.markers.resize(1);
  message.markers[0].header = header;
  message.markers[0].action = Marker::DELETEALL;
  if (!result.roll_found) return message;
  const roadstereo::GroundPlane plane = ground_plane(result.geometry.plane, calibration);
  const roadstereo::RoadAxes road = road_axes(plane);
  constexpr double line_share = 0.005;  // of the height of the camera
  for (const roadstereo::Damage& one : damage.damages) {
    if (!one.metrics || one.metrics->outline_m.empty()) continue;
    Marker outline;
    outline.header = header;
    outline.ns = name_of(one.metrics->distress);
    outline.id = one.id;
    outline.type = Marker::LINE_STRIP;
    outline.scale.x = line_share * plane.height_m;
    outline.color.r = outline.color.a = 1;
    std::vector<std::array<double, 2>> corners = one.metrics->outline_m;
    corners.push_back(corners.front());
    for (const auto& [x, y] : corners) {
      outline.points.emplace_back();
      outline.points.back().x = road.origin_m[0] + x * road.x[0] + y * road.y[0];
      outline.points.back().y = road.origin_m[1] + x * road.x[1] + y * road.y[1];
      outline.points.back().z = road.origin_m[2] + x * road.x[2] + y * road.y[2];
    }
    message.markers.push_back(outline);
  }
  return message;
}

}  // namespace roadstereo_ros
