#include "tests/io/source/bag_writer.hpp"

#include <rosbag/bag.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>

#include <algorithm>

struct BagWriter::Bag {
  rosbag::Bag bag;
};

BagWriter::BagWriter(const std::string& file) : bag_(new Bag) {
  bag_->bag.open(file, rosbag::bagmode::Write);
}

BagWriter::~BagWriter() = default;

void BagWriter::write_image(const std::string& topic, double stamp_s, double received_s, const Picture& picture) {
  sensor_msgs::Image message;
  message.header.seq = 7;
  message.header.stamp = ros::Time(stamp_s);
  message.header.frame_id = "camera";
  message.encoding = picture.encoding;
  message.width = static_cast<std::uint32_t>(picture.width);
  message.height = static_cast<std::uint32_t>(picture.height);
  message.step = static_cast<std::uint32_t>(picture.step);
  message.is_bigendian = picture.big_endian ? 1 : 0;
  message.data = picture.data;
  bag_->bag.write(topic, ros::Time(received_s), message);
}

void BagWriter::write_compressed(const std::string& topic, double stamp_s, double received_s, const std::string& format,
                                 const std::vector<std::uint8_t>& bytes) {
  sensor_msgs::CompressedImage message;
  message.header.stamp = ros::Time(stamp_s);
  message.format = format;
  message.data = bytes;
  bag_->bag.write(topic, ros::Time(received_s), message);
}

void BagWriter::write_camera(const std::string& topic, double stamp_s, const Camera& camera) {
  sensor_msgs::CameraInfo message;
  message.header.stamp = ros::Time(stamp_s);
  message.width = static_cast<std::uint32_t>(camera.width);
  message.height = static_cast<std::uint32_t>(camera.height);
  message.distortion_model = camera.distortion_model;
  message.D = camera.d;
  std::copy(camera.k.begin(), camera.k.end(), message.K.begin());
  std::copy(camera.r.begin(), camera.r.end(), message.R.begin());
  std::copy(camera.p.begin(), camera.p.end(), message.P.begin());
  bag_->bag.write(topic, ros::Time(stamp_s), message);
}

void BagWriter::close() {
  bag_->bag.close();
}
