#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <set>
#include <sstream>

#include "io/source/bag_message.hpp"
#include "io/source/bag_topics.hpp"
#include "io/source/nearest_pairs.hpp"
#include "io/source/numbered_pair.hpp"
#include "io/source/sources.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

std::vector<std::uint8_t> bytes_of(const rosbag::MessageInstance& message) {
  std::vector<std::uint8_t> bytes(message.size());
  ros::serialization::OStream stream(bytes.data(), message.size());
  message.write(stream);
  return bytes;
}

void open_for_reading(rosbag::Bag& bag, const std::string& file) {
  if (!std::filesystem::is_regular_file(file)) fail(file, ": the file does not exist, or is not a regular file");
  try {
    bag.open(file, rosbag::bagmode::Read);
  } catch (const rosbag::BagUnindexedException&) {
    fail(file, ": the bag has no index, because the recording was interrupted; rosbag reindex ", file, " creates it");
  } catch (const ros::Exception& error) {
    fail(file, ": this is not a readable ROS 1 bag (", error.what(), "); if it is truncated, rosbag reindex ", file,
         " may repair it");
  }
}

std::vector<BagTopic> topics_of(rosbag::View& view) {
  std::vector<BagTopic> topics;
  std::set<std::string> seen;
  for (const rosbag::ConnectionInfo* connection : view.getConnections()) {
    if (seen.insert(connection->topic).second) topics.push_back({connection->topic, connection->datatype});
  }
  return topics;
}

/// Reads messages one by one in the order of the recording; memory use is constant.
class BagSource final : public FrameSource {
 public:
  BagSource(const std::string& file, const SourceOptions& options)
      : file_(file), pairs_(options.max_time_difference_s) {
    open_for_reading(bag_, file);
    reading([&] {
      rosbag::View all(bag_);
      std::tie(left_, right_) = find_image_topics(file, topics_of(all), options.topics);
      images_ = std::make_unique<rosbag::View>(bag_, rosbag::TopicQuery({left_.name, right_.name}));
      at_ = images_->begin();
      count_ = std::max(messages(left_.name), messages(right_.name));
      read_camera_infos();
    });
  }

  std::optional<SourcePair> next() override {
    const std::optional<MatchedMessages> matched = next_messages();
    if (!matched) return std::nullopt;
    SourcePair pair = numbered_pair(index_++, 0);
    pair.time_s = 1e-9 * static_cast<double>((matched->left ? matched->left : matched->right)->stamp_ns);
    pair.error = matched->error;
    if (pair.error.empty()) decode(*matched, pair);
    return pair;
  }

  void skip(std::int64_t pairs) override {
    for (; pairs > 0 && next_messages(); --pairs) ++index_;
  }

  std::optional<std::int64_t> size() const override { return count_; }

  std::optional<CalibrationFile> calibration() const override {
    if (left_info_.empty() || right_info_.empty()) return std::nullopt;
    const CameraInfo left = camera_info(left_, left_info_);
    const CameraInfo right = camera_info(right_, right_info_);
    if (left.k(0, 0) == 0 && right.k(0, 0) == 0) return std::nullopt;  // not calibrated
    return join_camera_infos(left, right);
  }

  std::string description() const override {
    std::ostringstream text;
    text << "ROS bag, " << count_ << " pairs of " << left_.name << " and " << right_.name;
    return text.str();
  }

 private:
  /// Converts exceptions of ROS to Error naming the file.
  void reading(const std::function<void()>& call) const {
    try {
      call();
    } catch (const ros::Exception& error) {
      fail(file_, ": the bag cannot be read: ", error.what(), "; rosbag reindex ", file_, " may repair it");
    }
  }

  std::int64_t messages(const std::string& topic) {
    return static_cast<std::int64_t>(rosbag::View(bag_, rosbag::TopicQuery(topic)).size());
  }

  std::vector<std::uint8_t> first_message(const std::string& topic) {
    rosbag::View view(bag_, rosbag::TopicQuery(topic));
    const auto first = view.begin();
    if (first == view.end() || first->getDataType() != "sensor_msgs/CameraInfo") return {};
    return bytes_of(*first);
  }

  void read_camera_infos() {
    left_info_ = first_message(camera_info_topic(left_.name));
    right_info_ = first_message(camera_info_topic(right_.name));
  }

  /// The camera of the images of a topic: image_rect* are rectified, camera_info describes the raw images.
  CameraInfo camera_info(const BagTopic& image, const std::vector<std::uint8_t>& message) const {
    CameraInfo camera = read_camera_info(file_ + ": " + camera_info_topic(image.name), message);
    if (image.name.find("/image_rect") != std::string::npos) {
      camera.k = camera.p.get_minor<3, 3>(0, 0);
      camera.r = cv::Matx33d::eye();
      camera.d.clear();
      camera.distortion_model.clear();
    }
    return camera;
  }

  std::optional<MatchedMessages> next_messages() {
    while (true) {
      if (std::optional<MatchedMessages> matched = pairs_.next()) return matched;
      if (finished_) return std::nullopt;
      reading([this] { read_message(); });
    }
  }

  void read_message() {
    if (at_ == images_->end()) {
      finished_ = true;
      pairs_.finish();
      return;
    }
    TimedMessage message;
    message.bytes = bytes_of(*at_);
    message.stamp_ns = stamp_ns(file_ + ": " + at_->getTopic(), message.bytes);
    if (message.stamp_ns == 0) message.stamp_ns = static_cast<std::int64_t>(at_->getTime().toNSec());
    if (at_->getTopic() == left_.name) {
      pairs_.add_left(std::move(message));
    } else {
      pairs_.add_right(std::move(message));
    }
    ++at_;
  }

  static Frame read_view(const BagTopic& topic, const TimedMessage& message) {
    return topic.type == "sensor_msgs/Image" ? read_image(topic.name, message.bytes)
                                             : read_compressed_image(topic.name, message.bytes);
  }

  /// A damaged image invalidates its pair only.
  void decode(const MatchedMessages& matched, SourcePair& pair) const {
    try {
      pair.left = read_view(left_, *matched.left);
      pair.right = read_view(right_, *matched.right);
    } catch (const Error& error) {
      pair.error = error.what();
    }
  }

  std::string file_;
  rosbag::Bag bag_;
  BagTopic left_;
  BagTopic right_;
  std::unique_ptr<rosbag::View> images_;
  rosbag::View::iterator at_;
  NearestPairs pairs_;
  std::vector<std::uint8_t> left_info_;
  std::vector<std::uint8_t> right_info_;
  std::int64_t count_ = 0;
  std::int64_t index_ = 0;
  bool finished_ = false;
};

}  // namespace

std::unique_ptr<FrameSource> open_bag(const std::string& file, const SourceOptions& options) {
  return std::make_unique<BagSource>(file, options);
}

}  // namespace roadstereo::io
