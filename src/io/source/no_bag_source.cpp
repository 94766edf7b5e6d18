#include "io/source/sources.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {

std::unique_ptr<FrameSource> open_bag(const std::string& file, const SourceOptions&) {
  fail(file, ": this build does not support ROS bags; it needs the package librosbag-storage-dev");
}

}  // namespace roadstereo::io
