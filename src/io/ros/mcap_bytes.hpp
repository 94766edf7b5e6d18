// Records of MCAP files as bytes; little-endian.
#pragma once

#include <cstdint>
#include <cstring>
#include <map>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

#include "io/source/mcap_records.hpp"

namespace roadstereo::io {

/// Fields of a record, one after the other.
class McapBytes {
 public:
  template <class Value>
  requires std::is_arithmetic_v<Value> McapBytes& add(Value value) { return append(&value, sizeof value); }
  McapBytes& add(std::string_view letters) {
    add(static_cast<std::uint32_t>(letters.size()));
    return append(letters.data(), letters.size());
  }
  McapBytes& add(std::span<const std::uint8_t> raw) { return append(raw.data(), raw.size()); }
  /// A map, preceded by its length in bytes.
  McapBytes& add(const std::map<std::uint16_t, std::uint64_t>& numbers) {
    add(static_cast<std::uint32_t>(numbers.size() * (sizeof(std::uint16_t) + sizeof(std::uint64_t))));
    for (const auto& [topic, number] : numbers) add(topic).add(number);
    return *this;
  }
  /// A whole record.
  McapBytes& add(McapOpcode opcode, const McapBytes& content) {
    return add(static_cast<std::uint8_t>(opcode))
        .add(std::uint64_t{content.bytes_.size()})
        .add(std::span(content.bytes_));
  }

  const std::vector<std::uint8_t>& bytes() const { return bytes_; }

 private:
  McapBytes& append(const void* from, std::size_t count) {
    const std::size_t at = bytes_.size();
    bytes_.resize(at + count);
    if (count > 0) std::memcpy(bytes_.data() + at, from, count);
    return *this;
  }

  std::vector<std::uint8_t> bytes_;
};

}  // namespace roadstereo::io
