#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <stdexcept>
#include <string>

namespace roadstereo {

/// A file in memory for readers that take a path.
class MemoryFile {
 public:
  MemoryFile() : descriptor_(memfd_create("fuzz", 0)), path_("/proc/self/fd/" + std::to_string(descriptor_)) {}

  /// Replaces the contents; returns the path.
  const std::string& hold(const std::uint8_t* data, std::size_t size) {
    const bool held =
        ftruncate(descriptor_, 0) == 0 && pwrite(descriptor_, data, size, 0) == static_cast<ssize_t>(size);
    if (!held) throw std::runtime_error("the file in memory cannot be written");
    return path_;
  }

 private:
  int descriptor_;
  std::string path_;
};

}  // namespace roadstereo
