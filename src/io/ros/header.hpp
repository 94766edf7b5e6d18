#pragma once

#include <cstdint>
#include <string>

#include "io/ros/cdr_writer.hpp"

namespace roadstereo::io {

/// std_msgs/Header
struct RosHeader {
  std::uint64_t stamp_ns = 0;  ///< since 1970
  std::string frame;           ///< of the coordinates
};

inline void add_header(const RosHeader& header, CdrWriter& cdr) {
  constexpr std::uint64_t second = 1'000'000'000;
  cdr.add(static_cast<std::int32_t>(header.stamp_ns / second));
  cdr.add(static_cast<std::uint32_t>(header.stamp_ns % second)).text(header.frame);
}

}  // namespace roadstereo::io
