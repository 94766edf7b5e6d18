#include "io/source/message_log.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {

std::unique_ptr<MessageLog> open_ros1_log(const std::string& path) {
  fail(path, ": this build does not support ROS 1 bags; it needs the package librosbag-storage-dev");
}

}  // namespace roadstereo::io
