#include "io/netpbm.hpp"

#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <string_view>

#include "core/image_limits.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

bool is_space(std::uint8_t c) {
  return c == ' ' || (c >= '\t' && c <= '\r');
}

/// Reads the words of a header: separated by white space; `#` starts a comment up to the end of the line.
class Words {
 public:
  Words(const std::string& path, Bytes bytes) : path_(path), bytes_(bytes) {}

  std::string_view next(const char* what) {
    skip_space();
    const std::size_t start = at_;
    while (at_ < bytes_.size() && !is_space(bytes_[at_])) ++at_;
    if (start == at_) fail(path_, ": the file is truncated: ", what, " is missing");
    return {reinterpret_cast<const char*>(bytes_.data() + start), at_ - start};
  }

  template <class Number>
  Number number(const char* what) {
    const std::string_view word = next(what);
    Number value{};
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc{} || end != word.data() + word.size()) {
      fail(path_, ": ", what, " is \"", word.substr(0, 40), "\"; it must be a number");
    }
    return value;
  }

  /// Returns the `size` bytes of samples, and what follows, after the single white space that ends the header, or
  /// after the CRLF of some writers.
  Bytes rest(std::size_t size) const {
    const Bytes data = bytes_.subspan(std::min(at_ + 1, bytes_.size()));
    const bool crlf = data.size() > size && bytes_[at_] == '\r' && data[0] == '\n';
    return crlf ? data.subspan(1) : data;
  }

 private:
  void skip_space() {
    bool comment = false;
    for (; at_ < bytes_.size() && (comment || is_space(bytes_[at_]) || bytes_[at_] == '#'); ++at_) {
      if (bytes_[at_] == '#') comment = true;
      if (bytes_[at_] == '\n') comment = false;
    }
  }

  const std::string& path_;
  Bytes bytes_;
  std::size_t at_ = 2;  // after the two letters that name the format
};

struct NetpbmHeader {
  bool text = false;
  int channels = 1;
  int white = 255;
};

void read_text_samples(const std::string& path, Words& words, const NetpbmHeader& header, Frame& frame) {
  const std::size_t samples = frame.bytes.size() / (header.white > 255 ? 2 : 1);
  for (std::size_t i = 0; i < samples; ++i) {
    const int value = words.number<int>("a sample");
    if (value < 0 || value > header.white) {
      fail(path, ": a sample is ", value, "; it must be between 0 and ", header.white);
    }
    if (header.white > 255) {
      const auto wide = static_cast<std::uint16_t>(value);
      std::memcpy(frame.bytes.data() + 2 * i, &wide, 2);
    } else {
      frame.bytes[i] = static_cast<std::uint8_t>(value);
    }
  }
}

/// The file has as many bytes as the frame.
void read_binary_samples(const Words& words, Frame& frame) {
  const std::size_t size = frame.bytes.size();
  const Bytes data = words.rest(size);
  if (frame.sample == SampleType::u8) {
    std::memcpy(frame.bytes.data(), data.data(), size);
    return;
  }
  for (std::size_t i = 0; i < size; i += 2) {
    const auto value = static_cast<std::uint16_t>(data[i] << 8 | data[i + 1]);  // big-endian by definition
    std::memcpy(frame.bytes.data() + i, &value, 2);
  }
}

void stretch_to_white(int white, Frame& frame) {
  for (std::uint8_t& sample : frame.bytes) {
    sample = static_cast<std::uint8_t>(std::min((sample * 255 + white / 2) / white, 255));
  }
}

float float_at(const std::uint8_t* bytes, bool little_endian) {
  std::uint32_t bits = 0;
  for (unsigned i = 0; i < 4; ++i) {
    bits |= static_cast<std::uint32_t>(bytes[i]) << (8U * (little_endian ? i : 3 - i));
  }
  return std::bit_cast<float>(bits);
}

}  // namespace

bool is_netpbm(Bytes bytes) {
  return bytes.size() >= 3 && bytes[0] == 'P' && is_space(bytes[2]) &&
         (bytes[1] == '2' || bytes[1] == '3' || bytes[1] == '5' || bytes[1] == '6');
}

bool is_pfm(Bytes bytes) {
  return bytes.size() >= 3 && bytes[0] == 'P' && (bytes[1] == 'f' || bytes[1] == 'F') && is_space(bytes[2]);
}

void check_size(const std::string& path, std::int64_t width, std::int64_t height, int min_side, int max_side) {
  if (width < min_side || height < min_side || width > max_side || height > max_side) {
    fail(path, ": the image has ", width, "×", height, " pixels; it must have between ", min_side, "×", min_side,
         " and ", max_side, "×", max_side);
  }
}

Frame read_netpbm(const std::string& path, Bytes bytes) {
  NetpbmHeader header;
  header.text = bytes[1] == '2' || bytes[1] == '3';
  header.channels = bytes[1] == '3' || bytes[1] == '6' ? 3 : 1;
  Words words(path, bytes);
  Frame frame;
  frame.width = words.number<int>("the width");
  frame.height = words.number<int>("the height");
  check_size(path, frame.width, frame.height, min_image_side, max_image_side);
  header.white = words.number<int>("the largest value");
  if (header.white < 1 || header.white > 65535) {
    fail(path, ": the largest value is ", header.white, "; it must be between 1 and 65535");
  }
  frame.order = header.channels == 3 ? ChannelOrder::rgb : ChannelOrder::grey;
  frame.sample = header.white > 255 ? SampleType::u16 : SampleType::u8;
  const std::size_t size = static_cast<std::size_t>(frame.view().stride_bytes) * static_cast<std::size_t>(frame.height);
  const std::size_t samples = size / (frame.sample == SampleType::u16 ? 2 : 1);
  const std::size_t least = header.text ? 2 * samples - 1 : size;        // a digit and white space between two
  if (const std::size_t left = words.rest(size).size(); left < least) {  // before memory is taken
    fail(path, ": the file is truncated: ", least, " bytes of samples are expected, but there are ", left);
  }
  frame.bytes.resize(size);
  if (header.text) {
    read_text_samples(path, words, header, frame);
  } else {
    read_binary_samples(words, frame);
  }
  if (header.white < 255) stretch_to_white(header.white, frame);
  return frame;
}

Image<float> read_pfm(const std::string& path, Bytes bytes) {
  if (bytes[1] == 'F') fail(path, ": the PFM file has three channels; a disparity map has one");
  Words words(path, bytes);
  const int width = words.number<int>("the width");
  const int height = words.number<int>("the height");
  check_size(path, width, height, 1, max_image_side);
  const auto scale = words.number<double>("the scale");
  if (!std::isfinite(scale) || scale == 0) {
    fail(path, ": the scale is ", scale, "; it must not be 0, its sign is the byte order");
  }
  const std::size_t row_bytes = static_cast<std::size_t>(width) * sizeof(float);
  const std::size_t size = row_bytes * static_cast<std::size_t>(height);
  const Bytes data = words.rest(size);
  if (data.size() < size) {
    fail(path, ": the file is truncated: ", size, " bytes of values are expected, but there are ", data.size());
  }
  Image<float> map(width, height);
  for (int v = 0; v < height; ++v) {
    const std::uint8_t* in = data.data() + row_bytes * static_cast<std::size_t>(height - 1 - v);
    for (int u = 0; u < width; ++u, in += sizeof(float)) {
      const float value = float_at(in, scale < 0);
      map(u, v) = std::isfinite(value) ? value : std::numeric_limits<float>::quiet_NaN();
    }
  }
  return map;
}

}  // namespace roadstereo::io
