// A calibration of any format; also as both files of a ROS pair.
#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <string>

#include "roadstereo/error.hpp"
#include "roadstereo/io/calibration_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const int file = ::memfd_create("calibration", 0);
  static const std::string path = "/proc/self/fd/" + std::to_string(file);
  if (::ftruncate(file, 0) != 0 || ::pwrite(file, data, size, 0) != static_cast<ssize_t>(size)) return 0;
  for (const std::string& second : {std::string(), path}) {
    try {
      (void)roadstereo::io::read_calibration(path, second);
    } catch (const roadstereo::Error&) {
    }
  }
  return 0;
}
