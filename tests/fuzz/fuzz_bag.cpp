// A bag of ROS 2, MCAP or SQLite: all of its messages, as a source and as a track.
#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <string>

#include "io/encoded_frame.hpp"
#include "io/source/message_log.hpp"
#include "roadstereo/error.hpp"

// Compressed images are decoded by libraries that are fuzzed elsewhere.
roadstereo::Frame roadstereo::io::decode_frame(const std::string&, const std::vector<std::uint8_t>&) {
  return {};
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace roadstereo;
  static const int file = ::memfd_create("bag", 0);
  static const std::string path = "/proc/self/fd/" + std::to_string(file);
  if (::ftruncate(file, 0) != 0 || ::pwrite(file, data, size, 0) != static_cast<ssize_t>(size)) return 0;
  try {
    if (!io::is_message_log(path)) return 0;
    const auto log = io::open_message_log(path);
    std::vector<std::string> names;
    for (const io::BagTopic& topic : log->topics()) names.push_back(topic.name);
    log->select(names);
    while (const auto message = log->next()) {
      for (const io::BagTopic& topic : log->topics()) {
        if (topic.name != message->topic) continue;
        if (topic.type == "sensor_msgs/Image") (void)io::read_image(path, message->bytes, topic.format);
        if (topic.type == "sensor_msgs/CameraInfo") (void)io::read_camera_info(path, message->bytes, topic.format);
        if (topic.type == "sensor_msgs/NavSatFix") (void)io::read_satellite_fix(path, message->bytes, topic.format);
      }
    }
  } catch (const Error&) {
  }
  return 0;
}
