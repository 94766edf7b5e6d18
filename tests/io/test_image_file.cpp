#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <opencv2/imgcodecs.hpp>

#include "roadstereo/error.hpp"
#include "roadstereo/io/image_file.hpp"

namespace {

namespace fs = std::filesystem;
using namespace roadstereo;
using namespace roadstereo::io;

constexpr float nan_value = std::numeric_limits<float>::quiet_NaN();

class ImageFile : public testing::Test {
 protected:
  ImageFile() {
    std::string name = (fs::temp_directory_path() / "roadstereo-image-XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
  }
  ~ImageFile() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  std::string write(const std::string& name, const std::string& bytes) const {
    std::ofstream(path(name), std::ios::binary) << bytes;
    return path(name);
  }
  std::string write(const std::string& name, const std::vector<std::uint8_t>& bytes) const {
    return write(name, std::string(bytes.begin(), bytes.end()));
  }
  std::string write(const std::string& name, const cv::Mat& mat) const {
    std::vector<std::uint8_t> bytes;
    cv::imencode(fs::path(name).extension().string(), mat, bytes);
    return write(name, bytes);
  }

 private:
  fs::path folder_;
};

std::string message_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

std::string message_of_frame(const std::string& path) {
  return message_of([&] { read_frame(path); });
}
std::string message_of_disparity(const std::string& path) {
  return message_of([&] { read_disparity(path); });
}

/// Expects one sentence that names the file and says `part`, with nothing written to stderr beside it.
void expect_refused(const std::function<std::string()>& message, const std::string& path, const std::string& part) {
  testing::internal::CaptureStderr();
  const std::string text = message();
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_TRUE(text.starts_with(path)) << text;
  EXPECT_NE(text.find(part), std::string::npos) << text;
  EXPECT_EQ(text.find('\n'), std::string::npos) << text;
}
void expect_frame_refused(const std::string& path, const std::string& part) {
  expect_refused([&] { return message_of_frame(path); }, path, part);
}
void expect_disparity_refused(const std::string& path, const std::string& part) {
  expect_refused([&] { return message_of_disparity(path); }, path, part);
}

template <class Pixel>
cv::Mat ramp(int width, int height, int type) {
  cv::Mat mat(height, width, type);
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width * mat.channels(); ++u) {
      mat.ptr<Pixel>(v)[u] = static_cast<Pixel>(97 * u + 131 * v * (sizeof(Pixel) == 2 ? 257 : 1));
    }
  }
  return mat;
}

void expect_same(const Frame& frame, const cv::Mat& mat) {
  ASSERT_EQ(frame.width, mat.cols);
  ASSERT_EQ(frame.height, mat.rows);
  ASSERT_EQ(channel_count(frame.order), mat.channels());
  ASSERT_EQ(frame.sample, mat.depth() == CV_16U ? SampleType::u16 : SampleType::u8);
  const std::size_t row = static_cast<std::size_t>(mat.cols) * mat.elemSize();
  ASSERT_EQ(frame.bytes.size(), row * static_cast<std::size_t>(mat.rows));
  for (int v = 0; v < mat.rows; ++v) {
    ASSERT_EQ(std::memcmp(frame.bytes.data() + row * static_cast<std::size_t>(v), mat.ptr(v), row), 0) << "row " << v;
  }
}

std::string float_bytes(float value, bool little_endian) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  std::string bytes;
  for (unsigned i = 0; i < 4; ++i) {
    bytes += static_cast<char>(bits >> (8U * (little_endian ? i : 3 - i)) & 0xffU);
  }
  return bytes;
}

/// A directory entry of a little-endian TIFF.
std::string tiff_entry(int tag, int type, unsigned value) {
  std::string entry;
  for (const int part : {tag, type}) {
    entry += static_cast<char>(part & 0xff);
    entry += static_cast<char>(part >> 8);
  }
  entry += std::string("\1\0\0\0", 4);
  for (unsigned i = 0; i < 4; ++i) entry += static_cast<char>(value >> (8U * i) & 0xffU);
  return entry;
}

/// An uncompressed one-strip grey TIFF.
std::string small_tiff(unsigned width, unsigned height, unsigned bits, unsigned format, const std::string& data) {
  std::string file("II\x2a\0\x8\0\0\0\xa\0", 10);
  const unsigned data_at = 10 + 10 * 12 + 4;
  file += tiff_entry(256, 4, width) + tiff_entry(257, 4, height) + tiff_entry(258, 3, bits) + tiff_entry(259, 3, 1) +
          tiff_entry(262, 3, 1) + tiff_entry(273, 4, data_at) + tiff_entry(277, 3, 1) + tiff_entry(278, 4, height) +
          tiff_entry(279, 4, static_cast<unsigned>(data.size())) + tiff_entry(339, 3, format);
  return file + std::string(4, '\0') + data;
}

TEST_F(ImageFile, ReadsEveryPngFormat) {
  const cv::Mat kinds[] = {ramp<std::uint8_t>(33, 40, CV_8UC1),   ramp<std::uint8_t>(33, 40, CV_8UC3),
                           ramp<std::uint8_t>(33, 40, CV_8UC4),   ramp<std::uint16_t>(33, 40, CV_16UC1),
                           ramp<std::uint16_t>(33, 40, CV_16UC3), ramp<std::uint16_t>(33, 40, CV_16UC4)};
  for (const cv::Mat& mat : kinds) expect_same(read_frame(write("a.png", mat)), mat);
}

TEST_F(ImageFile, ReadsEveryTiffFormat) {
  const cv::Mat kinds[] = {ramp<std::uint8_t>(33, 40, CV_8UC1), ramp<std::uint8_t>(33, 40, CV_8UC3),
                           ramp<std::uint16_t>(33, 40, CV_16UC1), ramp<std::uint16_t>(33, 40, CV_16UC3)};
  for (const cv::Mat& mat : kinds) expect_same(read_frame(write("a.tiff", mat)), mat);
}

TEST_F(ImageFile, ReadsHandMadeTiff) {
  std::string data;
  for (int i = 0; i < 32 * 32; ++i) data += static_cast<char>(i % 251);
  const Frame frame = read_frame(write("a.tif", small_tiff(32, 32, 8, 1, data)));
  EXPECT_EQ(std::string(frame.bytes.begin(), frame.bytes.end()), data);
}

/// OpenCV leaves strips black that it cannot decode.
TEST_F(ImageFile, DamagedStripsOfTiffAreErrors) {
  cv::Mat mat(64, 200, CV_8UC3);
  cv::randu(mat, 0, 256);
  for (const int compression : {5, 32946}) {  // LZW, Deflate
    std::vector<std::uint8_t> bytes;
    cv::imencode(".tiff", mat, bytes, {cv::IMWRITE_TIFF_COMPRESSION, compression});
    expect_same(read_frame(write("whole.tiff", bytes)), mat);
    std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(bytes.size() / 2), 60, std::uint8_t{0xff});
    expect_frame_refused(write("damaged.tiff", bytes), "cannot be decoded");
  }
}

TEST_F(ImageFile, TurnedTiffIsRefused) {
  std::string file = small_tiff(32, 32, 8, 1, std::string(32 * 32, 'x'));
  file.replace(file.find(tiff_entry(277, 3, 1)), 12, tiff_entry(274, 3, 3));
  expect_frame_refused(write("turned.tif", file), "orientation 3");
}

TEST_F(ImageFile, IgnoresOrientationOfJpeg) {
  cv::Mat mat(40, 64, CV_8UC3, cv::Scalar(40, 90, 200));
  std::vector<std::uint8_t> bytes;
  cv::imencode(".jpg", mat, bytes);
  // An Exif segment that asks for a quarter turn (tag 0x0112 = 6), after the start-of-image marker.
  const std::string exif(
      "\xff\xe1\0\x22"
      "Exif\0\0"
      "II\x2a\0\x8\0\0\0\1\0"
      "\x12\1\3\0\1\0\0\0\6\0\0\0"
      "\0\0\0\0",
      36);
  bytes.insert(bytes.begin() + 2, exif.begin(), exif.end());
  const Frame frame = read_frame(write("a.jpg", bytes));
  EXPECT_EQ(frame.width, 64);
  EXPECT_EQ(frame.height, 40);
  ASSERT_EQ(frame.order, ChannelOrder::bgr);
  EXPECT_NEAR(frame.bytes[0], 40, 3);
  EXPECT_NEAR(frame.bytes[1], 90, 3);
  EXPECT_NEAR(frame.bytes[2], 200, 3);
}

TEST_F(ImageFile, ReadsBinaryAndTextNetpbm) {
  std::string grey = "P5\n# a comment\n32 33\n255\n";
  std::string text = "P2 32 33 255\n";
  for (int i = 0; i < 32 * 33; ++i) {
    grey += static_cast<char>(i % 256);
    text += std::to_string(i % 256) + (i % 20 == 19 ? "\n" : " ");
  }
  const Frame binary = read_frame(write("a.pgm", grey));
  EXPECT_EQ(binary.height, 33);
  EXPECT_EQ(binary.bytes[300], 300 % 256);
  EXPECT_EQ(read_frame(write("b.pgm", text)).bytes, binary.bytes);
  const Frame colour = read_frame(write("c.ppm", "P6 32 32 255\n" + std::string(32 * 32 * 3, 'x')));
  EXPECT_EQ(colour.order, ChannelOrder::rgb);
}

TEST_F(ImageFile, ScalesNetpbmByMaximum) {
  std::string wide = "P5 32 32 1023\n";
  for (int i = 0; i < 32 * 32; ++i) wide += std::string{static_cast<char>(i >> 8), static_cast<char>(i & 0xff)};
  const Frame frame = read_frame(write("a.pgm", wide));
  ASSERT_EQ(frame.sample, SampleType::u16);
  std::uint16_t sample = 0;
  std::memcpy(&sample, frame.bytes.data() + 2 * 1000, 2);
  EXPECT_EQ(sample, 1000);
  EXPECT_EQ(find_white_level(frame.view(), frame.view()), 1023);
  const Frame dim = read_frame(write("b.pgm", "P5 32 32 100\n" + std::string(32 * 32, '\x32')));
  EXPECT_EQ(dim.bytes[0], 128);  // 50 of 100
}

TEST_F(ImageFile, RejectsOtherFiles) {
  expect_frame_refused(path("none.png"), "does not exist");
  expect_frame_refused(fs::temp_directory_path().string(), "is a folder");
  expect_frame_refused("/dev/null", "not a regular file");
  expect_frame_refused(write("empty.png", ""), "empty");
  expect_frame_refused(write("text.png", "hello"), "not a PNG, JPEG, TIFF, PGM or PPM image");
}

TEST_F(ImageFile, RejectsDamagedPng) {
  std::vector<std::uint8_t> bytes;
  cv::imencode(".png", ramp<std::uint8_t>(64, 64, CV_8UC3), bytes);
  for (const std::size_t size : {std::size_t{9}, std::size_t{20}, bytes.size() / 2, bytes.size() - 1}) {
    expect_frame_refused(
        write("short.png", std::vector<std::uint8_t>(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size))),
        "truncated");
  }
  std::vector<std::uint8_t> flipped = bytes;
  flipped[bytes.size() / 2] ^= 0x10U;
  expect_frame_refused(write("flipped.png", flipped), "wrong checksum");
}

TEST_F(ImageFile, RejectsTruncatedJpegTiffAndNetpbm) {
  for (const char* name : {"a.jpg", "a.tiff"}) {
    std::vector<std::uint8_t> bytes;
    cv::imencode(fs::path(name).extension().string(), ramp<std::uint8_t>(64, 64, CV_8UC1), bytes);
    bytes.resize(bytes.size() / 2);
    expect_frame_refused(write(name, bytes), "truncated");
  }
  expect_frame_refused(write("b.tif", small_tiff(32, 32, 8, 1, "").replace(10 + 8 * 12 + 8, 2, "\0\4", 2)),
                       "truncated");
  expect_frame_refused(write("a.pgm", "P5 32 32 255\nabc"), "truncated");
  expect_frame_refused(write("b.pgm", "P2 32 32 255\n1 2 3"), "truncated");
  expect_frame_refused(write("c.pgm", "P2 32 32 255\n1 2 x" + std::string(2048, ' ')), "a sample is \"x\"");
}

/// Largest resident memory of this process since the last call, KiB.
long peak_memory_kib() {
  long peak = 0;
  std::string word;
  for (std::ifstream status("/proc/self/status"); status >> word;) {
    if (word == "VmHWM:") status >> peak;
  }
  std::ofstream("/proc/self/clear_refs") << 5;  // begins anew
  return peak;
}

TEST_F(ImageFile, ClaimsTakeNoMemory) {
  const std::string ppm = write("claim.ppm", "P6 8192 8192 255\n123456789");  // 192 MiB of samples
  // 600000 strips, more than an image of the largest size has tiles of 16×16 pixels.
  constexpr std::size_t offsets = 10 + 5 * 12, counts = 10 + 8 * 12, strips = 600000;
  std::string many = small_tiff(32, 32, 8, 1, std::string(4 * strips, '\0'));
  for (const std::size_t entry : {offsets, counts}) {
    many.replace(entry + 4, 4, "\xc0\x27\x09\0", 4).replace(entry + 8, 4, many, offsets + 8, 4);
  }
  const std::string tiff = write("claim.tif", many);
  many = {};
  peak_memory_kib();
  const long before = peak_memory_kib();
  expect_frame_refused(ppm, "truncated: 201326592 bytes of samples are expected, but there are 9");
  expect_frame_refused(tiff, "a tag has 600000 values");
  EXPECT_LT(peak_memory_kib() - before, 32 * 1024);
}

TEST_F(ImageFile, RejectsSizesAndDepths) {
  expect_frame_refused(write("small.png", cv::Mat(31, 64, CV_8UC1, cv::Scalar(7))), "64×31");
  expect_frame_refused(write("wide.png", cv::Mat(32, 8193, CV_8UC1, cv::Scalar(7))), "8193×32");
  expect_frame_refused(write("small.jpg", cv::Mat(16, 64, CV_8UC1, cv::Scalar(7))), "64×16");
  expect_frame_refused(write("small.pgm", "P5 8 8 255\n" + std::string(64, 'x')), "8×8");
  expect_frame_refused(write("float.tiff", cv::Mat(64, 64, CV_32FC1, cv::Scalar(7))), "32-bit floating-point");
  expect_frame_refused(write("wide.tif", small_tiff(32, 32, 32, 1, std::string(4096, 'x'))), "32-bit samples");
}

TEST_F(ImageFile, FindsWhiteLevelOfCamera) {
  const auto frame_with = [](std::uint16_t value, ChannelOrder order) {
    const cv::Mat mat(32, 32, CV_16UC(channel_count(order)), cv::Scalar::all(value));
    Frame frame{{}, 32, 32, SampleType::u16, order};
    frame.bytes.assign(mat.data, mat.data + mat.total() * mat.elemSize());
    return frame;
  };
  const Frame dark = frame_with(5, ChannelOrder::grey);
  const std::array<std::pair<int, double>, 6> cases{
      {{1023, 1023}, {1024, 4095}, {4095, 4095}, {4096, 16383}, {16384, 65535}, {65535, 65535}}};
  for (const auto& [value, white] : cases) {
    const Frame bright = frame_with(static_cast<std::uint16_t>(value), ChannelOrder::grey);
    EXPECT_EQ(find_white_level(dark.view(), bright.view()), white) << value;
    EXPECT_EQ(find_white_level(bright.view(), dark.view()), white) << value;
  }
  Frame opaque = frame_with(900, ChannelOrder::bgra);
  for (std::size_t i = 6; i < opaque.bytes.size(); i += 8) opaque.bytes[i] = opaque.bytes[i + 1] = 0xff;
  EXPECT_EQ(find_white_level(opaque.view(), opaque.view()), 1023);
  const Frame narrow{std::vector<std::uint8_t>(1024, 3), 32, 32, SampleType::u8, ChannelOrder::grey};
  EXPECT_EQ(find_white_level(narrow.view(), narrow.view()), 255);
  EXPECT_NE(message_of([&] { find_white_level(narrow.view(), dark.view()); }).find("8 bits"), std::string::npos);
}

TEST_F(ImageFile, ReadsPfmOfBothByteOrders) {
  const float infinity = std::numeric_limits<float>::infinity();
  for (const bool little : {true, false}) {
    std::string file = little ? "Pf\n3 2\n-1.0\n" : "Pf\n3 2\n0.5\n";
    for (const float value : {1.5f, 2.0f, infinity, 4.0f, -5.0f, nan_value}) file += float_bytes(value, little);
    const Image<float> map = read_disparity(write("a.pfm", file));
    ASSERT_EQ(map.width(), 3);
    ASSERT_EQ(map.height(), 2);
    EXPECT_EQ(map(0, 1), 1.5f);
    EXPECT_EQ(map(1, 1), 2.0f);
    EXPECT_TRUE(std::isnan(map(2, 1)));
    EXPECT_EQ(map(0, 0), 4.0f);
    EXPECT_EQ(map(1, 0), -5.0f);
    EXPECT_TRUE(std::isnan(map(2, 0)));
  }
}

TEST_F(ImageFile, FloatTiffKeepsEveryValue) {
  Image<float> map(5, 3, 1.25f);
  map(4, 0) = nan_value;
  map(2, 2) = 1023.875f;
  map(0, 1) = -3.5f;
  const Image<float> back = read_disparity(write("a.tiff", encode_float_tiff(map)));
  ASSERT_EQ(back.width(), 5);
  ASSERT_EQ(back.height(), 3);
  for (int v = 0; v < 3; ++v) {
    for (int u = 0; u < 5; ++u) {
      EXPECT_EQ(std::bit_cast<std::uint32_t>(back(u, v)) == std::bit_cast<std::uint32_t>(map(u, v)) ||
                    (std::isnan(back(u, v)) && std::isnan(map(u, v))),
                true)
          << u << ", " << v;
    }
  }
}

TEST_F(ImageFile, KittiPngHasSteps256thOfPixel) {
  Image<float> map(4, 1, nan_value);
  map(0, 0) = 1.0f;
  map(1, 0) = 0.001f;  // rounds to 0, which would mean invalid
  map(2, 0) = 255.99f;
  const std::vector<std::uint8_t> bytes = encode_kitti_png(map);
  const cv::Mat stored = cv::imdecode(bytes, cv::IMREAD_UNCHANGED);
  ASSERT_EQ(stored.type(), CV_16UC1);
  EXPECT_EQ(stored.at<std::uint16_t>(0), 256);
  EXPECT_EQ(stored.at<std::uint16_t>(1), 1);
  EXPECT_EQ(stored.at<std::uint16_t>(2), 65533);
  EXPECT_EQ(stored.at<std::uint16_t>(3), 0);
  const Image<float> back = read_disparity(write("a.png", bytes));
  EXPECT_EQ(back(0, 0), 1.0f);
  EXPECT_TRUE(std::isnan(back(3, 0)));
  map(3, 0) = -0.5f;
  EXPECT_NE(message_of([&] { encode_kitti_png(map); }).find("-0.5"), std::string::npos);
  map(3, 0) = 256.0f;
  EXPECT_NE(message_of([&] { encode_kitti_png(map); }).find("256"), std::string::npos);
}

TEST_F(ImageFile, RejectsFilesThatAreNoDisparityMap) {
  expect_disparity_refused(path("none.pfm"), "does not exist");
  expect_disparity_refused(write("a.png", cv::Mat(64, 64, CV_8UC1, cv::Scalar(7))), "16 bits");
  expect_disparity_refused(write("a.tiff", cv::Mat(64, 64, CV_8UC1, cv::Scalar(7))), "floating-point");
  expect_disparity_refused(write("a.jpg", cv::Mat(64, 64, CV_8UC1, cv::Scalar(7))), "not a disparity map");
  expect_disparity_refused(write("a.pfm", "Pf\n3 2\n-1\nabc"), "truncated");
  expect_disparity_refused(write("b.pfm", "PF\n3 2\n-1\nabc"), "three channels");
  expect_disparity_refused(write("c.pfm", "Pf\n3 2\n0\nabc"), "scale is 0");
  expect_disparity_refused(write("d.pfm", "Pf\n3 x\n0\nabc"), "the height is \"x\"");
}

TEST_F(ImageFile, HeaderOfNetpbmMayEndWithCrlf) {
  std::string samples;
  for (int i = 0; i < 32 * 32; ++i) samples += static_cast<char>(i % 251 + 1);
  for (const char* end : {"\n", "\r\n", "\r"}) {
    const Frame frame = read_frame(write("a.pgm", "P5 32 32 255" + std::string(end) + samples));
    EXPECT_EQ(std::memcmp(frame.bytes.data(), samples.data(), samples.size()), 0) << "header ends with " << end[0];
  }
  // The first value begins with a line feed, and a byte follows the last one.
  const std::string first("\n\0\200?", 4), second = float_bytes(2, true);
  const Image<float> map = read_disparity(write("a.pfm", "Pf\n2 1\n-1\n" + first + second + "\n"));
  EXPECT_EQ(map(0, 0), std::bit_cast<float>(0x3F80000AU));
  EXPECT_EQ(map(1, 0), 2.0f);
}

TEST_F(ImageFile, TextTooShortForItsSizeTakesNoMemory) {
  expect_frame_refused(write("a.ppm", "P3\n8192 8192\n65535\n1 2 3"), "truncated: 402653183 bytes");
}

TEST_F(ImageFile, PngKeepsColours) {
  Frame frame{{}, 2, 1, SampleType::u8, ChannelOrder::rgb};
  frame.bytes = {10, 20, 30, 40, 50, 60};
  const cv::Mat back = cv::imdecode(encode_png(frame.view()), cv::IMREAD_UNCHANGED);
  EXPECT_EQ(back.at<cv::Vec3b>(0), cv::Vec3b(30, 20, 10));
  EXPECT_EQ(back.at<cv::Vec3b>(1), cv::Vec3b(60, 50, 40));
  frame.order = ChannelOrder::bgr;
  EXPECT_EQ(cv::imdecode(encode_png(frame.view()), cv::IMREAD_UNCHANGED).at<cv::Vec3b>(0), cv::Vec3b(10, 20, 30));
}

TEST(ImageFileRealData, ReadsAll) {
  const char* data = std::getenv("ROADSTEREO_DATA");
  if (data == nullptr || !fs::exists(data)) GTEST_SKIP() << "ROADSTEREO_DATA does not name a folder: not tested";
  const fs::path root(data);
  const Frame frame = read_frame((root / "potholes/left/p1_01.png").string());
  EXPECT_EQ(frame.width, 2079);
  EXPECT_EQ(frame.height, 1040);
  const Image<float> motorcycle = read_disparity((root / "middlebury/Motorcycle/disp0GT.pfm").string());
  EXPECT_EQ(motorcycle.width(), 741);
  EXPECT_EQ(motorcycle.height(), 497);
  const Image<float> street = read_disparity((root / "kitti2015/disp_noc_0/000013_10.png").string());
  float nearest = 0;
  for (int v = 0; v < street.height(); ++v) {
    for (int u = 0; u < street.width(); ++u) {
      if (!std::isnan(street(u, v))) nearest = std::max(nearest, street(u, v));
    }
  }
  EXPECT_GT(nearest, 30);
  EXPECT_LT(nearest, 200);
}

}  // namespace
