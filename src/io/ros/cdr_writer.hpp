// Encoder of CDR, version 1, little-endian, as ROS 2 serialises messages (OMG DDSI-RTPS 10.5).
#pragma once

#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "roadstereo/error.hpp"

namespace roadstereo::io {

/// One message: its fields, one after the other, each aligned to its size from the end of the head of four bytes.
class CdrWriter {
 public:
  /// Appends a number or a bool.
  template <class Value>
  CdrWriter& add(Value value) {
    static_assert(std::is_arithmetic_v<Value>);
    bytes_.resize(head_bytes + (bytes_.size() - head_bytes + sizeof value - 1) / sizeof value * sizeof value);
    append(&value, sizeof value);
    return *this;
  }
  /// Appends numbers without a length: an array, or the numbers of a struct.
  template <class Values>
  CdrWriter& add_each(const Values& values) {
    for (const auto value : values) add(value);
    return *this;
  }
  /// Appends the length of a sequence, before its elements.
  CdrWriter& count(std::size_t elements) {
    if (elements > std::numeric_limits<std::uint32_t>::max()) {
      fail("a ROS message has a list of ", elements, " elements; it can have at most 4294967295");
    }
    return add(static_cast<std::uint32_t>(elements));
  }
  CdrWriter& text(std::string_view letters) {
    count(letters.size() + 1);
    append(letters.data(), letters.size());
    bytes_.push_back(0);
    return *this;
  }
  /// Appends a sequence of bytes.
  CdrWriter& data(std::span<const std::uint8_t> content) {
    count(content.size());
    append(content.data(), content.size());
    return *this;
  }

  std::vector<std::uint8_t> take() { return std::move(bytes_); }

 private:
  static constexpr std::size_t head_bytes = 4;

  void append(const void* from, std::size_t count) {
    const std::size_t at = bytes_.size();
    bytes_.resize(at + count);
    if (count > 0) std::memcpy(bytes_.data() + at, from, count);
  }

  std::vector<std::uint8_t> bytes_{0, 1, 0, 0};  // CDR_LE
};

}  // namespace roadstereo::io
