#include "io/ros/dds_publisher.hpp"

#include <dds/dds.h>
#include <dds/ddsi/ddsi_cdrstream.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "roadstereo/error.hpp"
#include "ros2_types.h"

namespace roadstereo::io {
namespace {

using Descriptor = const dds_topic_descriptor_t*;

constexpr std::array<std::pair<std::string_view, Descriptor>, 7> types{{
    {"nav_msgs/msg/Odometry", &nav_msgs_msg_dds__Odometry__desc},
    {"sensor_msgs/msg/CameraInfo", &sensor_msgs_msg_dds__CameraInfo__desc},
    {"sensor_msgs/msg/CompressedImage", &sensor_msgs_msg_dds__CompressedImage__desc},
    {"sensor_msgs/msg/PointCloud2", &sensor_msgs_msg_dds__PointCloud2__desc},
    {"stereo_msgs/msg/DisparityImage", &stereo_msgs_msg_dds__DisparityImage__desc},
    {"tf2_msgs/msg/TFMessage", &tf2_msgs_msg_dds__TFMessage__desc},
    {"visualization_msgs/msg/MarkerArray", &visualization_msgs_msg_dds__MarkerArray__desc},
}};

/// Throws Error for what Cyclone DDS reports as a negative number.
dds_entity_t require(dds_return_t result, const std::string& what) {
  if (result < 0) fail(what, ": Cyclone DDS reports \"", dds_strretcode(-result), "\"");
  return result;
}

/// A message as its type in C, which owns its memory.
class Sample {
 public:
  explicit Sample(Descriptor type) : type_(type), bytes_(dds_alloc(type->m_size)) {
    std::memset(bytes_, 0, type->m_size);
  }
  ~Sample() { dds_sample_free(bytes_, type_, DDS_FREE_ALL); }
  Sample(const Sample&) = delete;
  Sample& operator=(const Sample&) = delete;

  /// Decodes CDR, little-endian, of this type.
  void read(std::span<const std::uint8_t> cdr) {
    constexpr std::size_t head = 4;
    dds_istream_t stream;
    dds_istream_init(&stream, static_cast<std::uint32_t>(cdr.size() - head), cdr.data() + head, CDR_ENC_VERSION_1);
    dds_stream_read(&stream, static_cast<char*>(bytes_), type_->m_ops);
  }
  const void* get() const { return bytes_; }

 private:
  Descriptor type_;
  void* bytes_;
};

}  // namespace

struct DdsPublisher::State {
  struct Writer {
    Descriptor type;
    dds_entity_t entity;
  };
  dds_entity_t participant;
  std::vector<Writer> writers;

  explicit State(std::uint32_t domain)
      : participant(require(dds_create_participant(domain, nullptr, nullptr),
                            "cannot join the DDS domain " + std::to_string(domain))) {}
  ~State() { dds_delete(participant); }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  void add(const RosTopic& topic) {
    const auto* const known =
        std::find_if(types.begin(), types.end(), [&](const auto& one) { return one.first == topic.type; });
    if (known == types.end()) fail("messages of the type ", topic.type, " cannot be published by DDS");
    const std::string name = "rt" + std::string(topic.name);
    const dds_entity_t created =
        require(dds_create_topic(participant, known->second, name.c_str(), nullptr, nullptr), name);
    const std::unique_ptr<dds_qos_t, decltype(&dds_delete_qos)> quality(dds_create_qos(), dds_delete_qos);
    dds_qset_reliability(quality.get(), DDS_RELIABILITY_RELIABLE, DDS_MSECS(10));
    dds_qset_history(quality.get(), DDS_HISTORY_KEEP_LAST, 1);
    writers.push_back({known->second, require(dds_create_writer(participant, created, quality.get(), nullptr), name)});
  }

  static bool has_subscriber(const Writer& writer) {
    dds_publication_matched_status_t status{};
    return dds_get_publication_matched_status(writer.entity, &status) == DDS_RETCODE_OK && status.current_count > 0;
  }
};

DdsPublisher::DdsPublisher(std::uint32_t domain, std::span<const RosTopic> topics) {
  constexpr std::uint32_t last_domain = 230;
  if (domain > last_domain) fail("the DDS domain is ", domain, "; it must be between 0 and ", last_domain);
  state_ = std::make_unique<State>(domain);
  for (const RosTopic& topic : topics) state_->add(topic);
}

DdsPublisher::~DdsPublisher() = default;

bool DdsPublisher::has_subscribers() const {
  return std::any_of(state_->writers.begin(), state_->writers.end(), State::has_subscriber);
}

void DdsPublisher::publish(std::span<const TopicMessage> messages) {
  for (const TopicMessage& message : messages) {
    const State::Writer& writer = state_->writers.at(message.topic);
    if (!State::has_subscriber(writer)) continue;
    Sample sample(writer.type);
    sample.read(message.bytes);
    const dds_return_t result = dds_write_ts(writer.entity, sample.get(), static_cast<dds_time_t>(message.time_ns));
    if (result != DDS_RETCODE_TIMEOUT) require(result, "a message cannot be published");
  }
}

}  // namespace roadstereo::io
