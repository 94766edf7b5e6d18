#include "roadstereo/io/image_file.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "core/image_limits.hpp"
#include "core/map_value.hpp"
#include "io/encoded_frame.hpp"
#include "io/file_bytes.hpp"
#include "io/frame_mat.hpp"
#include "io/image_check.hpp"
#include "io/netpbm.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

constexpr std::size_t max_bytes = std::size_t{1} << 30U;
constexpr double kitti_steps = 256;  // per pixel of disparity

cv::Mat decode(const std::string& path, const std::vector<std::uint8_t>& bytes) {
  cv::Mat mat;
  try {
    mat = cv::imdecode(bytes, cv::IMREAD_UNCHANGED);  // also ignores the Exif orientation
  } catch (const cv::Exception&) {
    mat.release();
  }
  if (mat.empty()) fail(path, ": the image cannot be decoded; the file is damaged or of an unsupported type");
  return mat;
}

std::vector<std::uint8_t> encode(const char* extension, const cv::Mat& mat, const std::vector<int>& parameters) {
  std::vector<std::uint8_t> bytes;
  bool good = false;
  try {
    good = cv::imencode(extension, mat, bytes, parameters);
  } catch (const cv::Exception&) {
    good = false;
  }
  if (!good) fail<SystemError>("an image of ", mat.cols, "×", mat.rows, " pixels cannot be encoded as ", extension);
  return bytes;
}

/// Decodes PNG, JPEG or TIFF. Throws Error if a side is not within `smallest_side` … `max_image_side` pixels.
cv::Mat decode_checked(const std::string& path, const std::vector<std::uint8_t>& bytes, int smallest_side,
                       ImageHeader& header) {
  std::vector<std::uint8_t> essential;
  if (is_png(bytes)) {
    header = check_png(path, bytes, essential);
  } else if (is_jpeg(bytes)) {
    header = check_jpeg(path, bytes);
  } else {
    header = check_tiff(path, bytes);
  }
  check_size(path, header.width, header.height, smallest_side, max_image_side);
  if (is_tiff(bytes)) check_tiff_decodes(path, bytes);
  return decode(path, essential.empty() ? bytes : essential);
}

void check_frame_depth(const std::string& path, const cv::Mat& mat) {
  if (mat.depth() != CV_8U && mat.depth() != CV_16U) {
    fail(path, ": the image's samples have ", 8 * mat.elemSize1(),
         " bits or a sign; they must be unsigned integers of 8 or 16 bits");
  }
  if (mat.channels() != 1 && mat.channels() != 3 && mat.channels() != 4) {
    fail(path, ": the image has ", mat.channels(), " channels; it must have 1, 3 or 4");
  }
}

/// Rejects TIFF samples that the decoder would print warnings for.
void check_tiff_depth(const std::string& path, const ImageHeader& header) {
  if (header.is_float || (header.bits != 8 && header.bits != 16)) {
    fail(path, ": the image has ", header.bits, header.is_float ? "-bit floating-point" : "-bit",
         " samples; they must be integers of 8 or 16 bits");
  }
}

ChannelOrder order_of(const cv::Mat& mat) {
  if (mat.channels() == 1) return ChannelOrder::grey;
  return mat.channels() == 3 ? ChannelOrder::bgr : ChannelOrder::bgra;
}

std::uint16_t max_sample(const FrameView& frame) {
  const int channels = channel_count(frame.order);
  const int colours = channels == 4 ? 3 : channels;  // without alpha
  std::uint16_t largest = 0;
  for (int v = 0; v < frame.height; ++v) {
    const auto* row =
        reinterpret_cast<const std::uint16_t*>(static_cast<const std::uint8_t*>(frame.data) + v * frame.stride_bytes);
    for (int u = 0; u < frame.width; ++u, row += channels) {
      for (int c = 0; c < colours; ++c) largest = std::max(largest, row[c]);
    }
  }
  return largest;
}

Image<float> disparity_from_tiff(const std::string& path, const std::vector<std::uint8_t>& bytes) {
  ImageHeader header = check_tiff(path, bytes);
  if (!header.is_float || header.bits != 32 || header.channels != 1) {
    fail(path, ": the TIFF file has ", header.channels, " channel(s) of ", header.bits, "-bit ",
         header.is_float ? "floating-point" : "integer", " numbers; a disparity TIFF has one of 32-bit floating-point");
  }
  const cv::Mat mat = decode_checked(path, bytes, 1, header);
  if (mat.type() != CV_32FC1) fail(path, ": the TIFF file cannot be decoded as 32-bit floating-point numbers");
  Image<float> map(mat.cols, mat.rows);
  for (int v = 0; v < mat.rows; ++v) {
    std::transform(mat.ptr<float>(v), mat.ptr<float>(v) + mat.cols, map.row(v),
                   [](float value) { return std::isfinite(value) ? value : std::numeric_limits<float>::quiet_NaN(); });
  }
  return map;
}

Image<float> disparity_from_png(const std::string& path, const std::vector<std::uint8_t>& bytes) {
  ImageHeader header;
  const cv::Mat mat = decode_checked(path, bytes, 1, header);
  if (mat.type() != CV_16UC1) {
    fail(path, ": the PNG file has ", mat.channels(), " channel(s) of ", 8 * mat.elemSize1(),
         " bits; a disparity PNG has one channel of 16 bits (256 times the disparity)");
  }
  Image<float> map(mat.cols, mat.rows);
  for (int v = 0; v < mat.rows; ++v) {
    std::transform(
        mat.ptr<std::uint16_t>(v), mat.ptr<std::uint16_t>(v) + mat.cols, map.row(v), [](std::uint16_t value) {
          return value == 0 ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(value / kitti_steps);
        });
  }
  return map;
}

/// What many programs write for no data, such as −3.4e38, and infinity become NaN.
Image<float> without_no_data(Image<float> map) {
  for (int v = 0; v < map.height(); ++v) {
    std::replace_if(
        map.row(v), map.row(v) + map.width(), [](float value) { return !(std::abs(value) <= max_map_value); },
        std::numeric_limits<float>::quiet_NaN());
  }
  return map;
}

std::uint16_t kitti_value(float disparity) {
  constexpr float max_px = 255.99F;
  if (!std::isfinite(disparity)) return 0;
  if (disparity < 0 || disparity > max_px) {
    fail("a disparity is ", disparity, " px; a 16-bit PNG can store 0 … ", max_px, " px, a TIFF any value");
  }
  return static_cast<std::uint16_t>(std::max(std::lround(kitti_steps * disparity), 1L));
}

}  // namespace

Frame decode_frame(const std::string& path, const std::vector<std::uint8_t>& bytes) {
  if (is_netpbm(bytes)) return read_netpbm(path, bytes);
  if (!is_png(bytes) && !is_jpeg(bytes) && !is_tiff(bytes)) {
    fail(path, ": this is not a PNG, JPEG, TIFF, PGM or PPM image");
  }
  if (is_tiff(bytes)) check_tiff_depth(path, check_tiff(path, bytes));
  ImageHeader header;
  const cv::Mat mat = decode_checked(path, bytes, min_image_side, header);
  check_frame_depth(path, mat);
  return frame_from(mat, order_of(mat));
}

Frame read_frame(const std::string& path) {
  return decode_frame(path, read_file(path, max_bytes));
}

double find_white_level(const FrameView& left, const FrameView& right) {
  if (left.sample != right.sample)
    fail("one image of the pair has 8 bits, the other 16; both must have the same depth");
  if (left.sample == SampleType::u8) return 255;
  const int largest = std::max(max_sample(left), max_sample(right));
  for (const int white : {1023, 4095, 16383}) {
    if (largest <= white) return white;
  }
  return 65535;
}

Image<float> read_disparity(const std::string& path) {
  const std::vector<std::uint8_t> bytes = read_file(path, max_bytes);
  if (is_pfm(bytes)) return without_no_data(read_pfm(path, bytes));
  if (is_tiff(bytes)) return without_no_data(disparity_from_tiff(path, bytes));
  if (is_png(bytes)) return disparity_from_png(path, bytes);
  fail(path, ": this is not a disparity map; it must be a float TIFF, a PFM or a 16-bit PNG");
}

std::vector<std::uint8_t> encode_float_tiff(ImageView<const float> map) {
  constexpr int no_compression = 1;  // supported by every reader of float TIFF
  return encode(".tiff", mat_over(map), {cv::IMWRITE_TIFF_COMPRESSION, no_compression});
}

std::vector<std::uint8_t> encode_kitti_png(ImageView<const float> disparity) {
  cv::Mat mat(disparity.height(), disparity.width(), CV_16UC1);
  for (int v = 0; v < disparity.height(); ++v) {
    std::transform(disparity.row(v), disparity.row(v) + disparity.width(), mat.ptr<std::uint16_t>(v), kitti_value);
  }
  return encode(".png", mat, {});
}

std::vector<std::uint8_t> encode_png(const FrameView& frame, std::optional<int> compression) {
  std::vector<int> parameters;
  if (compression) parameters = {cv::IMWRITE_PNG_COMPRESSION, *compression};
  const cv::Mat mat = mat_over(frame);
  if (frame.order != ChannelOrder::rgb && frame.order != ChannelOrder::rgba) return encode(".png", mat, parameters);
  cv::Mat swapped;
  cv::cvtColor(mat, swapped, frame.order == ChannelOrder::rgb ? cv::COLOR_RGB2BGR : cv::COLOR_RGBA2BGRA);
  return encode(".png", swapped, parameters);
}

}  // namespace roadstereo::io
