// Composable node: synchronised rectified images and camera_info in; disparities, points and damage out.
#if __has_include(<message_filters/subscriber.hpp>)
#include <message_filters/subscriber.hpp>
#include <message_filters/sync_policies/approximate_time.hpp>
#include <message_filters/synchronizer.hpp>
#else
#include <message_filters/subscriber.h>
#include <message_filters/sync_policies/approximate_time.h>
#include <message_filters/synchronizer.h>
#endif
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <rclcpp/rclcpp.hpp>
#include <rclcpp_components/register_node_macro.hpp>
#include <roadstereo/error.hpp>
#include <roadstereo/options.hpp>
#include <string>
#include <vector>

#include "conversions.hpp"

namespace roadstereo_ros {

class RoadStereoNode : public rclcpp::Node {
 public:
  explicit RoadStereoNode(const rclcpp::NodeOptions& options)
      : Node("roadstereo", options), synchronizer_(Policy(queue_length), left_, left_info_, right_, right_info_) {
    options_ = roadstereo::preset(declare_parameter<std::string>("preset", "default"));
    for (const std::string& setting : declare_parameter("settings", std::vector<std::string>{})) {
      const std::size_t equals = setting.find('=');
      if (equals == std::string::npos) roadstereo::fail("settings has \"", setting, "\"; it must be key=value");
      set_option(options_, setting.substr(0, equals), setting.substr(equals + 1));
    }
    options_.validate();
    const rclcpp::QoS reliable(queue_length);  // RViz and others would get nothing of best effort
    disparity_ = create_publisher<stereo_msgs::msg::DisparityImage>("disparity", reliable);
    points_ = create_publisher<sensor_msgs::msg::PointCloud2>("points", reliable);
    damages_ = create_publisher<visualization_msgs::msg::MarkerArray>("damages", rclcpp::QoS(1));
    synchronizer_.registerCallback(std::bind(&RoadStereoNode::process, this, std::placeholders::_1,
                                             std::placeholders::_2, std::placeholders::_3, std::placeholders::_4));
    const rmw_qos_profile_t quality = rclcpp::SensorDataQoS().get_rmw_qos_profile();
    left_.subscribe(this, "left/image_rect", quality);
    left_info_.subscribe(this, "left/camera_info", quality);
    right_.subscribe(this, "right/image_rect", quality);
    right_info_.subscribe(this, "right/camera_info", quality);
  }

 private:
  using Image = sensor_msgs::msg::Image;
  using CameraInfo = sensor_msgs::msg::CameraInfo;
  using Policy = message_filters::sync_policies::ApproximateTime<Image, CameraInfo, Image, CameraInfo>;
  static constexpr std::uint32_t queue_length = 5;

  /// The synchroniser takes the nearest views, however far apart they are.
  static void require_one_moment(const std_msgs::msg::Header& left, const std_msgs::msg::Header& right) {
    constexpr double max_difference_s = 0.005, nanosecond = 1e-9;
    const double seconds = static_cast<double>(left.stamp.sec) - static_cast<double>(right.stamp.sec);
    const double rest_s = nanosecond * (static_cast<double>(left.stamp.nanosec) - right.stamp.nanosec);
    if (std::abs(seconds + rest_s) <= max_difference_s) return;
    roadstereo::fail("left and right were taken ", std::abs(seconds + rest_s), " s apart; the limit is ",
                     max_difference_s, " s");
  }

  void process(const Image::ConstSharedPtr& left, const CameraInfo::ConstSharedPtr& left_info,
               const Image::ConstSharedPtr& right, const CameraInfo::ConstSharedPtr& right_info) {
    try {
      require_one_moment(left->header, right->header);
      if (!pipeline_ || left_info->p != left_p_ || right_info->p != right_p_) {
        calibration_ = stereo_calibration(*left_info, *right_info);
        pipeline_.emplace(options_, calibration_);
        left_p_ = left_info->p;
        right_p_ = right_info->p;
      }
      publish(left->header, pipeline_->process(frame_view(*left), frame_view(*right)));
    } catch (const roadstereo::Error& error) {
      constexpr int every_ms = 5000;
      RCLCPP_WARN_THROTTLE(get_logger(), *get_clock(), every_ms, "%s", error.what());
    }
  }

  void publish(const std_msgs::msg::Header& header, const roadstereo::FrameResult& result) {
    disparity_->publish(disparity_image(header, result, calibration_));
    if (points_->get_subscription_count() > 0) points_->publish(point_cloud(header, result, calibration_));
    if (damages_->get_subscription_count() == 0) return;
    pipeline_->find_damage(damage_);
    damages_->publish(damage_markers(header, result, damage_, calibration_));
  }

  roadstereo::PipelineOptions options_;
  roadstereo::StereoCalibration calibration_;
  std::optional<roadstereo::Pipeline> pipeline_;  // made anew when the calibration changes
  roadstereo::DamageMap damage_;
  CameraInfo::_p_type left_p_, right_p_;

  message_filters::Subscriber<Image> left_, right_;
  message_filters::Subscriber<CameraInfo> left_info_, right_info_;
  message_filters::Synchronizer<Policy> synchronizer_;
  rclcpp::Publisher<stereo_msgs::msg::DisparityImage>::SharedPtr disparity_;
  rclcpp::Publisher<sensor_msgs::msg::PointCloud2>::SharedPtr points_;
  rclcpp::Publisher<visualization_msgs::msg::MarkerArray>::SharedPtr damages_;
};

}  // namespace roadstereo_ros

RCLCPP_COMPONENTS_REGISTER_NODE(roadstereo_ros::RoadStereoNode)
