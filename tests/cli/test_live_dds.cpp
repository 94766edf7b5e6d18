// `live --dds` in a process of its own; a reader of Cyclone DDS in this one takes what it publishes.
#include <dds/dds.h>
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <thread>

#include "ros2_types.h"
#include "tests/cli/live_dds_test.hpp"

namespace roadstereo {
namespace {

/// The newest message of a topic.
template <class Message>
class Reader {
 public:
  Reader(dds_entity_t participant, const dds_topic_descriptor_t& type, const char* topic) {
    dds_qos_t* quality = dds_create_qos();
    dds_qset_reliability(quality, DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
    reader_ =
        dds_create_reader(participant, dds_create_topic(participant, &type, topic, nullptr, nullptr), quality, nullptr);
    dds_delete_qos(quality);
  }
  ~Reader() { release(); }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  /// Waits for a message; null after half a minute.
  const Message* wait() {
    release();
    for (int i = 0; i < 3000; ++i) {
      dds_sample_info_t info;
      if (dds_take(reader_, &sample_, &info, 1, 1) == 1 && info.valid_data) return static_cast<const Message*>(sample_);
      release();
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return nullptr;
  }

 private:
  void release() {
    if (sample_ != nullptr) dds_return_loan(reader_, &sample_, 1);
    sample_ = nullptr;
  }

  dds_entity_t reader_ = 0;
  void* sample_ = nullptr;
};

class LiveDds : public LiveDdsTest {
 protected:
  static constexpr unsigned domain = 97;

  LiveDds() : LiveDdsTest(domain) {
    ::setenv("CYCLONEDDS_URI",
             "<General><Interfaces><NetworkInterface name=\"lo\" multicast=\"true\"/></Interfaces></General>", 1);
    participant_ = dds_create_participant(domain, nullptr, nullptr);
  }
  ~LiveDds() override { dds_delete(participant_); }

  dds_entity_t participant_ = 0;
};

TEST_F(LiveDds, OtherProcessReceivesEveryTopic) {
  Reader<stereo_msgs_msg_dds__DisparityImage_> disparities(participant_, stereo_msgs_msg_dds__DisparityImage__desc,
                                                           "rt/roadstereo/disparity");
  Reader<sensor_msgs_msg_dds__PointCloud2_> clouds(participant_, sensor_msgs_msg_dds__PointCloud2__desc,
                                                   "rt/roadstereo/points");
  Reader<visualization_msgs_msg_dds__MarkerArray_> damages(participant_, visualization_msgs_msg_dds__MarkerArray__desc,
                                                           "rt/roadstereo/damages");
  Reader<nav_msgs_msg_dds__Odometry_> odometry(participant_, nav_msgs_msg_dds__Odometry__desc,
                                               "rt/roadstereo/odometry");
  Reader<tf2_msgs_msg_dds__TFMessage_> transforms(participant_, tf2_msgs_msg_dds__TFMessage__desc, "rt/tf");

  const auto* const map = disparities.wait();
  ASSERT_NE(map, nullptr);
  EXPECT_STREQ(map->image_.encoding_, "32FC1");
  EXPECT_EQ(map->f_, 175);  // of the scene, for 320 columns
  EXPECT_EQ(map->t_, 0.12F);
  ASSERT_EQ(map->image_.data_._length, 320U * 180 * 4);
  const std::time_t now = std::time(nullptr);
  EXPECT_NEAR(map->header_.stamp_.sec_, static_cast<double>(now), 60);

  const auto* const cloud = clouds.wait();
  ASSERT_NE(cloud, nullptr);
  EXPECT_STREQ(cloud->header_.frame_id_, "left_camera_optical");
  ASSERT_EQ(cloud->fields_._length, 5U);
  EXPECT_STREQ(cloud->fields_._buffer[3].name_, "sigma");
  ASSERT_EQ(cloud->data_._length, 20 * cloud->width_);
  ASSERT_GT(cloud->width_, 320U * 180 / 2);
  std::array<float, 5> point{};
  std::memcpy(point.data(), cloud->data_._buffer, sizeof point);
  EXPECT_GT(point[2], 0);

  const auto* const markers = damages.wait();
  ASSERT_NE(markers, nullptr);
  ASSERT_GE(markers->markers_._length, 1U);
  EXPECT_EQ(markers->markers_._buffer[0].action_, 3);

  // The camera is where the scene has it: 2.6 m above the road.
  const auto* const pose = odometry.wait();
  ASSERT_NE(pose, nullptr);
  EXPECT_STREQ(pose->child_frame_id_, "left_camera_optical");
  EXPECT_NEAR(pose->pose_.pose_.position_.z_, 2.6, 0.05);
  const auto* const moved = transforms.wait();
  ASSERT_NE(moved, nullptr);
  ASSERT_EQ(moved->transforms_._length, 2U);
  EXPECT_STREQ(moved->transforms_._buffer[1].child_frame_id_, "road");
}

}  // namespace
}  // namespace roadstereo
