#include "io/source/sources.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {

std::unique_ptr<FrameSource> open_bag(const std::string& file, const SourceOptions&) {
  fail(file, ": this program was built without ROS bags; Debian's librosbag-storage-dev is needed when it is built");
}

}  // namespace roadstereo::io
