#include <cstring>

#include "io/image_check.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

constexpr std::uint8_t end_of_image = 0xd9;
constexpr std::uint8_t start_of_scan = 0xda;

/// Start-of-frame markers; 0xc4, 0xc8 and 0xcc are in their range but are none.
bool is_start_of_frame(std::uint8_t marker) {
  return marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
}

bool stands_alone(std::uint8_t marker) {
  return marker == 0x01 || (marker >= 0xd0 && marker <= 0xd7);
}

int big_endian_16(Bytes bytes, std::size_t at) {
  return bytes[at] << 8 | bytes[at + 1];
}

/// Reads marker by marker; throws Error if the file is truncated.
class SegmentWalk {
 public:
  SegmentWalk(const std::string& path, Bytes bytes) : path_(path), bytes_(bytes) {}

  std::uint8_t next_marker() {
    need(2);
    if (bytes_[at_] != 0xff) fail(path_, ": the JPEG file is damaged: a marker is missing");
    while (need(2), bytes_[at_ + 1] == 0xff) ++at_;  // fill bytes
    at_ += 2;
    return bytes_[at_ - 1];
  }

  Bytes segment() {
    need(2);
    const auto length = static_cast<std::size_t>(big_endian_16(bytes_, at_));
    if (length < 2) fail(path_, ": the JPEG file is damaged: a segment has no length");
    need(length);
    at_ += length;
    return bytes_.subspan(at_ - length + 2, length - 2);
  }

  /// Skips coded data up to the first marker that is neither a stuffed zero nor a restart.
  void skip_coded_data() {
    for (;;) {
      need(2);
      const void* found = std::memchr(bytes_.data() + at_, 0xff, bytes_.size() - at_ - 1);
      if (found == nullptr) truncated();
      at_ = static_cast<std::size_t>(static_cast<const std::uint8_t*>(found) - bytes_.data());
      const std::uint8_t next = bytes_[at_ + 1];
      if (next != 0 && next != 0xff && !(next >= 0xd0 && next <= 0xd7)) return;
      at_ += next == 0xff ? 1 : 2;
    }
  }

 private:
  void need(std::size_t count) const {
    if (bytes_.size() - at_ < count) truncated();
  }
  [[noreturn]] void truncated() const { fail(path_, ": the JPEG file is truncated"); }

  const std::string& path_;
  Bytes bytes_;
  std::size_t at_ = 2;  // after the start-of-image marker
};

ImageHeader read_frame_header(const std::string& path, Bytes segment) {
  if (segment.size() < 6) fail(path, ": the JPEG file is damaged: its frame header is short");
  ImageHeader header;
  header.bits = segment[0];
  header.height = big_endian_16(segment, 1);
  header.width = big_endian_16(segment, 3);
  header.channels = segment[5];
  if (header.bits != 8) fail(path, ": the JPEG file has ", header.bits, " bits per sample; it must have 8");
  return header;
}

}  // namespace

bool is_jpeg(Bytes bytes) {
  return bytes.size() >= 3 && bytes[0] == 0xff && bytes[1] == 0xd8 && bytes[2] == 0xff;
}

ImageHeader check_jpeg(const std::string& path, Bytes bytes) {
  SegmentWalk walk(path, bytes);
  ImageHeader header;
  bool has_frame = false;
  bool has_scan = false;
  for (std::uint8_t marker = walk.next_marker(); marker != end_of_image; marker = walk.next_marker()) {
    if (stands_alone(marker)) continue;
    const Bytes segment = walk.segment();
    if (is_start_of_frame(marker)) {
      header = read_frame_header(path, segment);
      has_frame = true;
    } else if (marker == start_of_scan) {
      walk.skip_coded_data();
      has_scan = true;
    }
  }
  if (!has_frame || !has_scan) fail(path, ": the JPEG file is damaged: it has no image");
  return header;
}

}  // namespace roadstereo::io
