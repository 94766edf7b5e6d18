// An image file, as a frame and as a disparity map.
#include <opencv2/core/utils/logger.hpp>

#include "memory_file.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/io/image_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace roadstereo;
  static MemoryFile file;
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  const std::string& path = file.hold(data, size);
  try {
    (void)io::read_frame(path);
  } catch (const Error&) {
  }
  try {
    (void)io::read_disparity(path);
  } catch (const Error&) {
  }
  return 0;
}
