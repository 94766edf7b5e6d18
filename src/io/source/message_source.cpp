#include <algorithm>
#include <sstream>
#include <tuple>
#include <utility>

#include "io/source/bag_message.hpp"
#include "io/source/bag_topics.hpp"
#include "io/source/message_log.hpp"
#include "io/source/nearest_pairs.hpp"
#include "io/source/numbered_pair.hpp"
#include "io/source/sources.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

/// Pairs the images of two topics of a bag by their time stamps. Memory use is constant.
class MessageSource final : public FrameSource {
 public:
  MessageSource(const std::string& file, const SourceOptions& options)
      : file_(file), log_(open_message_log(file)), pairs_(options.max_time_difference_s), rate_hz_(options.rate_hz) {
    std::tie(left_, right_) = find_image_topics(file, log_->topics(), options.topics);
    left_info_ = first_camera_info(left_);
    right_info_ = first_camera_info(right_);
    log_->select({left_.name, right_.name});
  }

  std::optional<SourcePair> next() override {
    const std::optional<MatchedMessages> matched = next_messages();
    if (!matched) return std::nullopt;
    SourcePair pair = numbered_pair(index_++, rate_hz_);
    if (rate_hz_ == 0 && (matched->left || matched->right)) {
      pair.time_s = 1e-9 * static_cast<double>((matched->left ? matched->left : matched->right)->stamp_ns);
    }
    pair.error = matched->error;
    if (pair.error.empty()) decode(*matched, pair);
    return pair;
  }

  void skip(std::int64_t pairs) override {
    for (; pairs > 0 && next_messages(); --pairs) ++index_;
  }

  std::optional<std::int64_t> size() const override { return std::max(left_.messages, right_.messages); }

  std::optional<CalibrationFile> calibration() const override {
    if (!info_error_.empty()) fail(info_error_);
    if (!left_info_ || !right_info_) return std::nullopt;
    if (left_info_->k(0, 0) == 0 && right_info_->k(0, 0) == 0) return std::nullopt;  // not calibrated
    return join_camera_infos(*left_info_, *right_info_);
  }

  std::string description() const override {
    std::ostringstream text;
    text << log_->kind() << ", " << std::max(left_.messages, right_.messages) << " pairs of " << left_.name << " and "
         << right_.name;
    return text.str();
  }

 private:
  /// The camera of the images of a topic: image_rect* are rectified, camera_info describes the raw images.
  std::optional<CameraInfo> first_camera_info(const BagTopic& image) {
    const std::string name = camera_info_topic(image.name);
    for (const BagTopic& topic : log_->topics()) {
      if (topic.name != name || topic.type != "sensor_msgs/CameraInfo") continue;
      log_->select({name});
      std::optional<LoggedMessage> message = log_->next();
      std::string lost;
      for (; message && !message->error.empty(); message = log_->next()) lost = message->error;
      if (!message) {
        if (!lost.empty()) info_error_ = lost;
        return std::nullopt;
      }
      CameraInfo camera;
      try {
        camera = read_camera_info(file_ + ": " + name, message->bytes, topic.format);
      } catch (const SystemError&) {
        throw;
      } catch (const Error& error) {  // matters to nobody who has a calibration file
        info_error_ = error.what();
        return std::nullopt;
      }
      if (image.name.find("/image_rect") != std::string::npos) {
        camera.k = camera.p.get_minor<3, 3>(0, 0);
        camera.r = cv::Matx33d::eye();
        camera.d.clear();
        camera.distortion_model.clear();
      }
      return camera;
    }
    return std::nullopt;
  }

  std::optional<MatchedMessages> next_messages() {
    while (true) {
      if (std::optional<MatchedMessages> matched = pairs_.next()) return matched;
      if (finished_) return std::nullopt;
      std::optional<LoggedMessage> logged = log_->next();
      if (!logged) {
        finished_ = true;
        pairs_.finish();
        continue;
      }
      if (logged->error.empty()) add(*logged);
      if (!logged->error.empty()) return MatchedMessages{{}, {}, logged->error};
    }
  }

  /// Adds a message to those that wait for their partners. Sets its error if it ends before its time stamp.
  void add(LoggedMessage& logged) {
    const bool is_left = logged.topic == left_.name;
    TimedMessage message;
    message.bytes = std::move(logged.bytes);
    try {
      message.stamp_ns = stamp_ns(file_ + ": " + logged.topic, message.bytes, (is_left ? left_ : right_).format);
    } catch (const Error& error) {
      logged.error = error.what();
      return;
    }
    if (message.stamp_ns == 0) message.stamp_ns = logged.received_ns;
    if (is_left) {
      pairs_.add_left(std::move(message));
    } else {
      pairs_.add_right(std::move(message));
    }
  }

  static Frame read_view(const BagTopic& topic, const TimedMessage& message) {
    return topic.type == "sensor_msgs/Image" ? read_image(topic.name, message.bytes, topic.format)
                                             : read_compressed_image(topic.name, message.bytes, topic.format);
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
  std::unique_ptr<MessageLog> log_;
  BagTopic left_, right_;
  NearestPairs pairs_;
  double rate_hz_;
  std::optional<CameraInfo> left_info_, right_info_;
  std::string info_error_;  ///< why there is none
  std::int64_t index_ = 0;
  bool finished_ = false;
};

}  // namespace

std::unique_ptr<FrameSource> open_bag(const std::string& file, const SourceOptions& options) {
  return std::make_unique<MessageSource>(file, options);
}

}  // namespace roadstereo::io
