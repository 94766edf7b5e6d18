#include "io/source/message_log.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

[[noreturn]] void fail_without_ros2(const std::string& path) {
  fail(path, ": this build does not support bags of ROS 2; it needs the packages libsqlite3-dev, libzstd-dev and ",
       "liblz4-dev");
}

}  // namespace

std::unique_ptr<MessageLog> open_sqlite_log(const std::string& path) {
  fail_without_ros2(path);
}

std::unique_ptr<MessageLog> open_mcap_log(const std::string& path) {
  fail_without_ros2(path);
}

std::unique_ptr<MessageLog> open_rosbag2_folder(const std::string& path) {
  fail_without_ros2(path);
}

}  // namespace roadstereo::io
