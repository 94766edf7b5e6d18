#include "io/source/bag_message.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <opencv2/imgproc.hpp>
#include <span>
#include <string_view>

#include "io/encoded_frame.hpp"
#include "io/frame_mat.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

static_assert(std::endian::native == std::endian::little, "messages are read without byte swapping");

class MessageReader {
 public:
  MessageReader(const std::string& source, std::span<const std::uint8_t> message, MessageFormat format)
      : source_(source), rest_(message), format_(format) {
    if (format == MessageFormat::ros1) return;
    const auto encapsulation = bytes(4);  // alignment counts from its end
    if (encapsulation[0] != 0 || encapsulation[1] != 1) {
      fail(source, ": the message is CDR of kind ", int{encapsulation[0]}, " ", int{encapsulation[1]},
           "; only plain little-endian CDR, 0 1, is supported");
    }
    begin_ = rest_.data();
  }

  std::span<const std::uint8_t> bytes(std::size_t count) {
    if (count > rest_.size()) fail(source_, ": the message is truncated");
    const auto taken = rest_.first(count);
    rest_ = rest_.subspan(count);
    return taken;
  }
  template <class Value>
  Value value() {
    align(sizeof(Value));
    Value value{};
    std::memcpy(&value, bytes(sizeof value).data(), sizeof value);
    return value;
  }
  template <class Value, int Count>
  void values(Value (&target)[Count]) {
    align(sizeof(Value));
    std::memcpy(target, bytes(sizeof target).data(), sizeof target);
  }
  std::span<const std::uint8_t> list(std::size_t bytes_each = 1) {
    const std::size_t count = value<std::uint32_t>();
    if (count > 0) align(bytes_each);
    return bytes(bytes_each * count);
  }
  std::string text() {
    auto letters = list();
    if (format_ == MessageFormat::cdr && !letters.empty() && letters.back() == 0) {
      letters = letters.first(letters.size() - 1);  // CDR counts the end of the string
    }
    return {letters.begin(), letters.end()};
  }
  std::int64_t header() {
    if (format_ == MessageFormat::ros1) value<std::uint32_t>();  // sequence number
    const std::int64_t seconds = value<std::uint32_t>();
    const std::int64_t nanoseconds = value<std::uint32_t>();
    text();  // frame_id
    return 1'000'000'000 * seconds + nanoseconds;
  }
  int side(const char* name) {
    constexpr std::uint32_t max_side = 65535;
    const auto pixels = value<std::uint32_t>();
    if (pixels > max_side) fail(source_, ": ", name, " is ", pixels, "; it must be at most ", max_side);
    return static_cast<int>(pixels);
  }

 private:
  void align(std::size_t size) {
    if (format_ == MessageFormat::ros1) return;
    const auto past = static_cast<std::size_t>(rest_.data() - begin_) % size;
    if (past > 0) bytes(size - past);
  }

  const std::string& source_;
  std::span<const std::uint8_t> rest_;
  MessageFormat format_;
  const std::uint8_t* begin_ = nullptr;
};

constexpr int no_conversion = -1;

struct Encoding {
  std::string_view name;
  int type;            // OpenCV's type of the samples in the message
  ChannelOrder order;  // of the frame
  int conversion;      // OpenCV's, of a Bayer pattern or of luma and chroma, to that order
};

constexpr std::array encodings = {
    Encoding{"mono8", CV_8UC1, ChannelOrder::grey, no_conversion},
    Encoding{"8UC1", CV_8UC1, ChannelOrder::grey, no_conversion},
    Encoding{"mono16", CV_16UC1, ChannelOrder::grey, no_conversion},
    Encoding{"16UC1", CV_16UC1, ChannelOrder::grey, no_conversion},
    Encoding{"bgr8", CV_8UC3, ChannelOrder::bgr, no_conversion},
    Encoding{"8UC3", CV_8UC3, ChannelOrder::bgr, no_conversion},
    Encoding{"rgb8", CV_8UC3, ChannelOrder::rgb, no_conversion},
    Encoding{"bgra8", CV_8UC4, ChannelOrder::bgra, no_conversion},
    Encoding{"rgba8", CV_8UC4, ChannelOrder::rgba, no_conversion},
    Encoding{"bgr16", CV_16UC3, ChannelOrder::bgr, no_conversion},
    Encoding{"rgb16", CV_16UC3, ChannelOrder::rgb, no_conversion},
    Encoding{"bgra16", CV_16UC4, ChannelOrder::bgra, no_conversion},
    Encoding{"rgba16", CV_16UC4, ChannelOrder::rgba, no_conversion},
    Encoding{"yuv422", CV_8UC2, ChannelOrder::bgr, cv::COLOR_YUV2BGR_UYVY},
    Encoding{"uyvy", CV_8UC2, ChannelOrder::bgr, cv::COLOR_YUV2BGR_UYVY},
    Encoding{"yuv422_yuy2", CV_8UC2, ChannelOrder::bgr, cv::COLOR_YUV2BGR_YUY2},
    Encoding{"yuyv", CV_8UC2, ChannelOrder::bgr, cv::COLOR_YUV2BGR_YUY2},
    // OpenCV names a Bayer pattern by the second and third pixel of its second row.
    Encoding{"bayer_rggb8", CV_8UC1, ChannelOrder::bgr, cv::COLOR_BayerBG2BGR},
    Encoding{"bayer_bggr8", CV_8UC1, ChannelOrder::bgr, cv::COLOR_BayerRG2BGR},
    Encoding{"bayer_gbrg8", CV_8UC1, ChannelOrder::bgr, cv::COLOR_BayerGR2BGR},
    Encoding{"bayer_grbg8", CV_8UC1, ChannelOrder::bgr, cv::COLOR_BayerGB2BGR},
    Encoding{"bayer_rggb16", CV_16UC1, ChannelOrder::bgr, cv::COLOR_BayerBG2BGR},
    Encoding{"bayer_bggr16", CV_16UC1, ChannelOrder::bgr, cv::COLOR_BayerRG2BGR},
    Encoding{"bayer_gbrg16", CV_16UC1, ChannelOrder::bgr, cv::COLOR_BayerGR2BGR},
    Encoding{"bayer_grbg16", CV_16UC1, ChannelOrder::bgr, cv::COLOR_BayerGB2BGR},
};

const Encoding& find_encoding(const std::string& source, const std::string& name) {
  const auto found =
      std::find_if(encodings.begin(), encodings.end(), [&](const Encoding& e) { return e.name == name; });
  if (found != encodings.end()) return *found;
  fail(source, ": the encoding is \"", name, "\"; supported are mono, rgb, bgr, rgba, bgra and bayer of 8 or 16 bits, ",
       "and yuv422");
}

/// Encoding of an image before its compression, of "bayer_rggb8; jpeg compressed "; the whole text without a ";".
std::string compressed_encoding(const std::string& format) {
  return format.substr(0, format.find(';'));
}

Frame converted(const std::string& source, const cv::Mat& samples, const Encoding& encoding) {
  if (encoding.type == CV_8UC2 && samples.cols % 2 != 0) {
    fail(source, ": an image of ", samples.cols, " columns cannot be ", encoding.name, ", which has pairs of them");
  }
  cv::Mat colours;
  cv::cvtColor(samples, colours, encoding.conversion);
  return frame_from(colours, encoding.order);
}

void swap_bytes(Frame& frame) {
  for (std::size_t i = 0; i + 1 < frame.bytes.size(); i += 2) std::swap(frame.bytes[i], frame.bytes[i + 1]);
}

}  // namespace

std::int64_t stamp_ns(const std::string& source, const std::vector<std::uint8_t>& message, MessageFormat format) {
  return MessageReader(source, message, format).header();
}

Frame read_image(const std::string& source, const std::vector<std::uint8_t>& message, MessageFormat format) {
  MessageReader reader(source, message, format);
  reader.header();
  const int height = reader.side("height");
  const int width = reader.side("width");
  const Encoding& encoding = find_encoding(source, reader.text());
  const bool big_endian = reader.value<std::uint8_t>() != 0;
  const std::size_t step = reader.value<std::uint32_t>();
  const auto data = reader.list();
  const std::size_t row = static_cast<std::size_t>(width) * static_cast<std::size_t>(CV_ELEM_SIZE(encoding.type));
  if (width == 0 || height == 0 || step < row || step % CV_ELEM_SIZE1(encoding.type) != 0 ||
      data.size() < step * static_cast<std::size_t>(height)) {
    fail(source, ": ", data.size(), " bytes in rows of ", step, " are not an image of ", width, "×", height,
         " pixels (", encoding.name, ")");
  }
  const cv::Mat samples(height, width, encoding.type, const_cast<std::uint8_t*>(data.data()), step);
  if (encoding.type == CV_8UC2) return converted(source, samples, encoding);
  const bool is_mosaic = encoding.conversion != no_conversion;
  Frame frame = frame_from(samples, is_mosaic ? ChannelOrder::grey : encoding.order);
  if (big_endian && frame.sample == SampleType::u16) swap_bytes(frame);
  return is_mosaic ? converted(source, mat_over(frame.view()), encoding) : frame;
}

Frame read_compressed_image(const std::string& source, const std::vector<std::uint8_t>& message, MessageFormat format) {
  MessageReader reader(source, message, format);
  reader.header();
  const std::string name = compressed_encoding(reader.text());
  const auto data = reader.list();
  Frame frame = decode_frame(source, {data.begin(), data.end()});
  if (!name.starts_with("bayer_") || frame.order != ChannelOrder::grey) return frame;
  return converted(source, mat_over(frame.view()), find_encoding(source, name));
}

CameraInfo read_camera_info(const std::string& source, const std::vector<std::uint8_t>& message, MessageFormat format) {
  MessageReader reader(source, message, format);
  reader.header();
  CameraInfo camera;
  camera.source = source;
  camera.height = reader.side("height");
  camera.width = reader.side("width");
  camera.distortion_model = reader.text();
  const auto distortion = reader.list(sizeof(double));
  camera.d.resize(distortion.size() / sizeof(double));
  if (!distortion.empty()) std::memcpy(camera.d.data(), distortion.data(), distortion.size());
  reader.values(camera.k.val);
  reader.values(camera.r.val);
  reader.values(camera.p.val);
  const auto binning_x = reader.value<std::uint32_t>();
  const auto binning_y = reader.value<std::uint32_t>();
  const auto left = reader.value<std::uint32_t>();
  const auto top = reader.value<std::uint32_t>();
  if (binning_x > 1 || binning_y > 1 || left > 0 || top > 0) {
    fail(source,
         ": camera_info with binning or a region of interest is not supported; use a calibration file of these ",
         "images");
  }
  return camera;
}

SatelliteFix read_satellite_fix(const std::string& source, const std::vector<std::uint8_t>& message,
                                MessageFormat format) {
  MessageReader reader(source, message, format);
  SatelliteFix fix;
  fix.stamp_ns = reader.header();
  fix.valid = reader.value<std::int8_t>() >= 0;  // STATUS_NO_FIX is -1
  reader.value<std::uint16_t>();                 // kinds of satellites
  fix.lat_deg = reader.value<double>();
  fix.lon_deg = reader.value<double>();
  fix.alt_m = reader.value<double>();
  std::array<double, 9> covariance{};  // of east, north, up
  for (double& value : covariance) value = reader.value<double>();
  if (reader.value<std::uint8_t>() == 0) return fix;  // COVARIANCE_TYPE_UNKNOWN
  fix.horizontal_variance_m2 = (covariance[0] + covariance[4]) / 2;
  fix.vertical_variance_m2 = covariance[8];
  return fix;
}

}  // namespace roadstereo::io
