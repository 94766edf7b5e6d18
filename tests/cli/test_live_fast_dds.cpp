// `live --dds` as Fast DDS sees it, the other implementation that ROS 2 uses: names match, and its own decoder of CDR
// reads the messages.
#include <fastcdr/Cdr.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/Topic.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "tests/cli/live_dds_test.hpp"

namespace roadstereo {
namespace {

namespace dds = eprosima::fastdds::dds;
using eprosima::fastrtps::rtps::InstanceHandle_t;
using eprosima::fastrtps::rtps::SerializedPayload_t;
using Bytes = std::vector<char>;

/// A type by its name alone; its messages stay serialised.
class Serialised : public dds::TopicDataType {
 public:
  explicit Serialised(const char* name) {
    setName(name);
    m_typeSize = 1U << 20U;
  }
  bool serialize(void*, SerializedPayload_t*) override { return false; }
  bool deserialize(SerializedPayload_t* payload, void* message) override {
    static_cast<Bytes*>(message)->assign(payload->data, payload->data + payload->length);
    return true;
  }
  std::function<std::uint32_t()> getSerializedSizeProvider(void*) override {
    return [] { return 0U; };
  }
  void* createData() override { return new Bytes; }
  void deleteData(void* message) override { delete static_cast<Bytes*>(message); }
  bool getKey(void*, InstanceHandle_t*, bool) override { return false; }
};

class LiveFastDds : public LiveDdsTest {
 protected:
  static constexpr unsigned domain = 98;

  LiveFastDds()
      : LiveDdsTest(domain),
        participant_(factory().create_participant(domain, dds::PARTICIPANT_QOS_DEFAULT)),
        subscriber_(participant_->create_subscriber(dds::SUBSCRIBER_QOS_DEFAULT)) {}
  ~LiveFastDds() override {
    participant_->delete_contained_entities();
    factory().delete_participant(participant_);
  }

  dds::DataReader* reader(const char* topic, const char* type) {
    dds::TypeSupport(new Serialised(type)).register_type(participant_);
    dds::DataReaderQos quality = dds::DATAREADER_QOS_DEFAULT;
    quality.reliability().kind = dds::RELIABLE_RELIABILITY_QOS;
    return subscriber_->create_datareader(participant_->create_topic(topic, type, dds::TOPIC_QOS_DEFAULT), quality);
  }

  /// Waits for a message; empty after half a minute.
  static Bytes wait(dds::DataReader* reader) {
    Bytes message;
    dds::SampleInfo info;
    for (int i = 0; i < 3000; ++i) {
      if (reader->take_next_sample(&message, &info) == ReturnCode_t::RETCODE_OK && info.valid_data) return message;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return {};
  }

 private:
  static dds::DomainParticipantFactory& factory() { return *dds::DomainParticipantFactory::get_instance(); }

  dds::DomainParticipant* participant_;
  dds::Subscriber* subscriber_;
};

TEST_F(LiveFastDds, ReadsOdometryAndDisparities) {
  dds::DataReader* poses = reader("rt/roadstereo/odometry", "nav_msgs::msg::dds_::Odometry_");
  dds::DataReader* maps = reader("rt/roadstereo/disparity", "stereo_msgs::msg::dds_::DisparityImage_");
  Bytes bytes = wait(poses);
  ASSERT_FALSE(bytes.empty());
  eprosima::fastcdr::FastBuffer of_pose(bytes.data(), bytes.size());
  eprosima::fastcdr::Cdr pose(of_pose, eprosima::fastcdr::Cdr::DEFAULT_ENDIAN, eprosima::fastcdr::Cdr::DDS_CDR);
  pose.read_encapsulation();
  std::int32_t seconds = 0;
  std::uint32_t nanoseconds = 0;
  std::string frame, child;
  double x = 0, y = 0, z = 0;
  pose >> seconds >> nanoseconds >> frame >> child >> x >> y >> z;
  EXPECT_EQ(frame, "odom");
  EXPECT_EQ(child, "left_camera_optical");
  EXPECT_NEAR(z, 2.6, 0.05);

  bytes = wait(maps);
  ASSERT_FALSE(bytes.empty());
  eprosima::fastcdr::FastBuffer of_map(bytes.data(), bytes.size());
  eprosima::fastcdr::Cdr map(of_map, eprosima::fastcdr::Cdr::DEFAULT_ENDIAN, eprosima::fastcdr::Cdr::DDS_CDR);
  map.read_encapsulation();
  std::uint32_t height = 0, width = 0, step = 0;
  std::string encoding;
  std::uint8_t big_endian = 1;
  std::vector<std::uint8_t> data;
  float focal = 0, baseline = 0;
  map >> seconds >> nanoseconds >> frame >> seconds >> nanoseconds >> frame >> height >> width >> encoding;
  map >> big_endian >> step >> data >> focal >> baseline;
  EXPECT_EQ(encoding, "32FC1");
  EXPECT_EQ(data.size(), std::size_t{320} * 180 * 4);
  EXPECT_EQ(focal, 175);
  EXPECT_EQ(baseline, 0.12F);
}

}  // namespace
}  // namespace roadstereo
