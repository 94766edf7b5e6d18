#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <opencv2/imgcodecs.hpp>

#include "io/source/bag_topics.hpp"
#include "io/source/sources.hpp"
#include "roadstereo/error.hpp"
#include "tests/io/source/bag_writer.hpp"

namespace {

namespace fs = std::filesystem;
using namespace roadstereo;
using namespace roadstereo::io;

constexpr double start_s = 1'700'000'000;
const std::string left_topic = "/stereo/left/image_raw";
const std::string right_topic = "/stereo/right/image_raw";

std::string message_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

void expect_message(const std::function<void()>& call, const std::string& part) {
  const std::string message = message_of(call);
  EXPECT_NE(message.find(part), std::string::npos) << message << "\n does not say: " << part;
}

/// A grey picture of one level, its rows padded.
BagWriter::Picture grey(int level) {
  BagWriter::Picture picture{"mono8", 40, 32, 48, false, {}};
  picture.data.assign(std::size_t{48} * 32, 99);
  for (std::size_t v = 0; v < 32; ++v) std::fill_n(picture.data.begin() + static_cast<long>(48 * v), 40, level);
  return picture;
}

int first_sample(const Frame& frame) {
  return frame.bytes.at(0);
}

class BagSource : public testing::Test {
 protected:
  BagSource() {
    std::string name = (fs::temp_directory_path() / "roadstereo-bag-XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
  }
  ~BagSource() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  /// A bag of one pair with that left picture, and the left frame that it is read as.
  SourcePair pair_with(const BagWriter::Picture& picture) const {
    const std::string file = path("one.bag");
    BagWriter writer(file);
    writer.write_image(left_topic, start_s, start_s, picture);
    writer.write_image(right_topic, start_s, start_s, picture);
    writer.close();
    return open_bag(file, {})->next().value();
  }

 private:
  fs::path folder_;
};

TEST_F(BagSource, PairsByStamp) {
  const std::string file = path("flight.bag");
  BagWriter writer(file);
  for (int i = 0; i < 5; ++i) {
    const double stamp_s = start_s + 0.1 * i;
    writer.write_image(left_topic, stamp_s, stamp_s + 0.03, grey(10 + i));
    writer.write_image(right_topic, stamp_s + 0.002, stamp_s + 0.25, grey(110 + i));  // two later ones come first
  }
  writer.close();
  const auto source = open_bag(file, {});
  EXPECT_EQ(source->size(), 5);
  EXPECT_FALSE(source->live());
  EXPECT_FALSE(source->calibration());
  EXPECT_EQ(source->description(), "ROS bag, 5 pairs of " + left_topic + " and " + right_topic);
  source->skip(1);
  for (int i = 1; i < 5; ++i) {
    const std::optional<SourcePair> pair = source->next();
    ASSERT_TRUE(pair);
    EXPECT_EQ(pair->error, "");
    EXPECT_EQ(pair->index, i);
    EXPECT_NEAR(pair->time_s, start_s + 0.1 * i, 1e-6);
    ASSERT_EQ(pair->left.bytes.size(), std::size_t{40} * 32);  // without the padding
    EXPECT_EQ(pair->left.bytes, std::vector<std::uint8_t>(pair->left.bytes.size(), static_cast<std::uint8_t>(10 + i)));
    EXPECT_EQ(first_sample(pair->right), 110 + i);
  }
  EXPECT_FALSE(source->next());
}

TEST_F(BagSource, RejectsImageWithoutPartner) {
  const std::string file = path("flight.bag");
  BagWriter writer(file);
  const auto write = [&](const std::string& topic, double stamp_s, int level) {
    writer.write_image(topic, start_s + stamp_s, start_s + stamp_s, grey(level));
  };
  write(left_topic, 0.000, 1);
  write(right_topic, 0.004, 101);
  write(left_topic, 0.100, 2);  // its right one was lost
  write(left_topic, 0.200, 3);
  write(right_topic, 0.220, 103);  // 20 ms late
  write(left_topic, 0.301, 4);
  write(left_topic, 0.304, 5);
  write(right_topic, 0.305, 105);  // nearer to the second
  writer.close();
  struct Expected {
    double time_s;
    int left;
    int right;
    const char* error;
  };
  const std::vector<Expected> expected{
      {0.000, 1, 101, ""},
      {0.100, 0, 0, "the left image is unpaired: the nearest right one is 96 ms away, more than 5 ms"},
      {0.200, 0, 0, "the left image is unpaired: the nearest right one is 20 ms away, more than 5 ms"},
      {0.220, 0, 0, "the right image is unpaired: the nearest left one is 20 ms away, more than 5 ms"},
      {0.301, 0, 0, "the left image is unpaired: the nearest right one is 4 ms away, but is paired with another"},
      {0.304, 5, 105, ""}};
  const auto source = open_bag(file, {});
  for (const Expected& e : expected) {
    const std::optional<SourcePair> pair = source->next();
    ASSERT_TRUE(pair);
    EXPECT_NEAR(pair->time_s, start_s + e.time_s, 1e-6);
    EXPECT_EQ(pair->error, e.error);
    if (pair->error.empty()) {
      EXPECT_EQ(first_sample(pair->left), e.left);
      EXPECT_EQ(first_sample(pair->right), e.right);
    }
  }
  EXPECT_FALSE(source->next());
  SourceOptions generous;
  generous.max_time_difference_s = 0.03;
  const auto again = open_bag(file, generous);
  again->skip(2);
  EXPECT_EQ(again->next().value().error, "") << "20 ms are within 30";
}

TEST_F(BagSource, ContinuesAfterOneCameraStops) {
  const std::string file = path("flight.bag");
  BagWriter writer(file);
  for (int i = 0; i < 100; ++i) {
    writer.write_image(left_topic, start_s + 0.1 * i, start_s + 0.1 * i, grey(i));
    if (i < 10 || i >= 90) writer.write_image(right_topic, start_s + 0.1 * i, start_s + 0.1 * i, grey(100 + i));
  }
  writer.close();
  const auto source = open_bag(file, {});
  for (int i = 0; i < 100; ++i) {
    const std::optional<SourcePair> pair = source->next();
    ASSERT_TRUE(pair);
    EXPECT_EQ(pair->error.empty(), i < 10 || i >= 90) << i << ": " << pair->error;
  }
  EXPECT_FALSE(source->next());
}

TEST_F(BagSource, MissingStampIsTimeOfReception) {
  const std::string file = path("flight.bag");
  BagWriter writer(file);
  writer.write_image(left_topic, 0, start_s, grey(1));
  writer.write_image(right_topic, 0, start_s + 0.001, grey(2));
  writer.close();
  const SourcePair pair = open_bag(file, {})->next().value();
  EXPECT_EQ(pair.error, "");
  EXPECT_NEAR(pair.time_s, start_s, 1e-6);
}

TEST_F(BagSource, ReadsEveryEncoding) {
  const auto colour = [](const std::string& encoding, std::vector<std::uint8_t> pixel) {
    BagWriter::Picture picture{encoding, 32, 32, static_cast<int>(32 * pixel.size()), false, {}};
    for (int i = 0; i < 32 * 32; ++i) picture.data.insert(picture.data.end(), pixel.begin(), pixel.end());
    return picture;
  };
  const auto expect_pixel = [&](const BagWriter::Picture& picture, ChannelOrder order,
                                std::vector<std::uint8_t> pixel) {
    const SourcePair pair = pair_with(picture);
    ASSERT_EQ(pair.error, "") << picture.encoding;
    EXPECT_EQ(pair.left.order, order) << picture.encoding;
    const auto at = pair.left.bytes.begin() + static_cast<long>(pixel.size() * (32 * 7 + 9));
    EXPECT_EQ(std::vector<std::uint8_t>(at, at + static_cast<long>(pixel.size())), pixel) << picture.encoding;
  };
  expect_pixel(colour("rgb8", {1, 2, 3}), ChannelOrder::rgb, {1, 2, 3});
  expect_pixel(colour("bgr8", {1, 2, 3}), ChannelOrder::bgr, {1, 2, 3});
  expect_pixel(colour("rgba8", {1, 2, 3, 4}), ChannelOrder::rgba, {1, 2, 3, 4});
  expect_pixel(colour("bgra8", {1, 2, 3, 4}), ChannelOrder::bgra, {1, 2, 3, 4});
  expect_pixel(colour("mono16", {0x34, 0x12}), ChannelOrder::grey, {0x34, 0x12});
  BagWriter::Picture big = colour("mono16", {0x12, 0x34});
  big.big_endian = true;
  expect_pixel(big, ChannelOrder::grey, {0x34, 0x12});
  EXPECT_EQ(pair_with(big).left.sample, SampleType::u16);

  // Red 200, green 100, blue 50 through each mosaic; the name gives the first row, then the second.
  for (const std::string cells : {"rggb", "bggr", "gbrg", "grbg"}) {
    BagWriter::Picture picture{"bayer_" + cells + "8", 32, 32, 32, false, {}};
    for (int v = 0; v < 32; ++v) {
      for (int u = 0; u < 32; ++u) {
        const char cell = cells[static_cast<std::size_t>(2 * (v % 2) + u % 2)];
        picture.data.push_back(cell == 'r' ? 200 : (cell == 'g' ? 100 : 50));
      }
    }
    expect_pixel(picture, ChannelOrder::bgr, {50, 100, 200});
  }
}

/// Rec. 601: luma 81, Cb 90, Cr 240 is red (255, 0, 0).
TEST_F(BagSource, ReadsLumaAndChroma) {
  for (const auto& [encoding, cells] :
       {std::pair{"yuv422", std::array{90, 81, 240, 81}}, std::pair{"yuv422_yuy2", std::array{81, 90, 81, 240}}}) {
    BagWriter::Picture picture{encoding, 32, 32, 64, false, {}};
    for (int i = 0; i < 32 * 64; ++i) {
      picture.data.push_back(static_cast<std::uint8_t>(cells[static_cast<std::size_t>(i % 4)]));
    }
    const SourcePair pair = pair_with(picture);
    ASSERT_EQ(pair.error, "") << encoding;
    ASSERT_EQ(pair.left.order, ChannelOrder::bgr);
    EXPECT_NEAR(pair.left.bytes[0], 0, 2) << encoding;
    EXPECT_NEAR(pair.left.bytes[1], 0, 2) << encoding;
    EXPECT_NEAR(pair.left.bytes[2], 255, 2) << encoding;
  }
}

TEST_F(BagSource, DamagedImageCostsOnePair) {
  EXPECT_NE(pair_with({"mono16", 32, 32, 65, false, std::vector<std::uint8_t>(65 * 32)}).error, "");
  EXPECT_EQ(pair_with({"yuv9", 32, 32, 32, false, std::vector<std::uint8_t>(1024)}).error.rfind(left_topic, 0), 0U);
  BagWriter::Picture cut = grey(3);
  cut.data.resize(1000);
  EXPECT_NE(pair_with(cut).error.find("1000 bytes in rows of 48 are not an image of 40×32"), std::string::npos);
}

TEST_F(BagSource, ReadsCompressedImages) {
  const std::string file = path("flight.bag");
  BagWriter writer(file);
  std::vector<std::uint8_t> png;
  std::vector<std::uint8_t> jpeg;
  cv::imencode(".png", cv::Mat(32, 48, CV_8UC1, cv::Scalar(77)), png);
  cv::imencode(".jpg", cv::Mat(32, 48, CV_8UC3, cv::Scalar(30, 60, 90)), jpeg);
  writer.write_compressed("/cam0/image_raw/compressed", start_s, start_s, "png", png);
  writer.write_compressed("/cam1/image_raw/compressed", start_s, start_s, "bgr8; jpeg compressed bgr8", jpeg);
  jpeg.resize(jpeg.size() / 2);
  writer.write_compressed("/cam0/image_raw/compressed", start_s + 1, start_s + 1, "png", png);
  writer.write_compressed("/cam1/image_raw/compressed", start_s + 1, start_s + 1, "jpeg", jpeg);
  writer.close();
  const auto source = open_bag(file, {});
  const SourcePair pair = source->next().value();
  EXPECT_EQ(pair.error, "");
  EXPECT_EQ(pair.left.bytes, std::vector<std::uint8_t>(std::size_t{32} * 48, 77));
  ASSERT_EQ(pair.right.order, ChannelOrder::bgr);
  EXPECT_NEAR(pair.right.bytes[0], 30, 3);
  EXPECT_NEAR(pair.right.bytes[2], 90, 3);
  EXPECT_NE(source->next().value().error, "");
}

/// What image_transport makes of the raw image of a Bayer camera: its mosaic in grey, and the encoding in the format.
TEST_F(BagSource, DemosaicsCompressedImages) {
  const std::string file = path("flight.bag");
  BagWriter writer(file);
  cv::Mat mosaic(32, 48, CV_8UC1, cv::Scalar(100));
  for (int v = 0; v < 32; v += 2) {
    for (int u = 0; u < 48; u += 2) {
      mosaic.at<std::uint8_t>(v, u) = 200;
      mosaic.at<std::uint8_t>(v + 1, u + 1) = 50;
    }
  }
  std::vector<std::uint8_t> png;
  cv::imencode(".png", mosaic, png);
  writer.write_compressed("/cam0/image_raw/compressed", start_s, start_s, "bayer_rggb8; png compressed ", png);
  writer.write_compressed("/cam1/image_raw/compressed", start_s, start_s, "mono8; png compressed ", png);
  writer.close();
  const SourcePair pair = open_bag(file, {})->next().value();
  ASSERT_EQ(pair.error, "");
  ASSERT_EQ(pair.left.order, ChannelOrder::bgr);
  const auto at = pair.left.bytes.begin() + 3 * (48 * 7 + 9);
  EXPECT_EQ(std::vector<std::uint8_t>(at, at + 3), (std::vector<std::uint8_t>{50, 100, 200}));
  EXPECT_EQ(pair.right.order, ChannelOrder::grey);
}

BagWriter::Camera camera(double right_shift_px) {
  return {640,
          480,
          "plumb_bob",
          {0, 0, 0, 0, 0},
          {500, 0, 320, 0, 500, 240, 0, 0, 1},
          {1, 0, 0, 0, 1, 0, 0, 0, 1},
          {500, 0, 320, right_shift_px, 0, 500, 240, 0, 0, 0, 1, 0}};
}

TEST_F(BagSource, CameraInfoIsCalibration) {
  const auto calibration = [&](BagWriter::Camera left, BagWriter::Camera right, const std::string& image) {
    const std::string file = path("flight.bag");
    BagWriter writer(file);
    writer.write_camera("/stereo/left/camera_info", start_s, left);
    writer.write_camera("/stereo/right/camera_info", start_s, right);
    writer.write_image("/stereo/left/" + image, start_s, start_s, grey(1));
    writer.write_image("/stereo/right/" + image, start_s, start_s, grey(1));
    writer.close();
    return open_bag(file, {})->calibration();
  };
  const CalibrationFile rectified = calibration(camera(0), camera(-60), "image_raw").value();
  ASSERT_TRUE(rectified.rectified);
  EXPECT_EQ(rectified.rectified->focal_px, 500);
  EXPECT_EQ(rectified.rectified->cx_px, 320);
  EXPECT_EQ(rectified.rectified->cy_px, 240);
  EXPECT_DOUBLE_EQ(rectified.rectified->baseline_m, 0.12);  // 60 / 500
  EXPECT_EQ(rectified.rectified->width, 640);

  BagWriter::Camera lens = camera(0);
  lens.d = {0.1, -0.2, 0, 0, 0};
  const CalibrationFile rig = calibration(lens, camera(-60), "image_raw").value();
  ASSERT_TRUE(rig.rig);
  EXPECT_EQ(rig.rig->left_distortion, lens.d);
  EXPECT_NEAR(rig.rig->translation_m[0], -0.12, 1e-12);
  EXPECT_EQ(rig.rig->height, 480);
  EXPECT_TRUE(calibration(lens, camera(-60), "image_rect").value().rectified);  // the lens is undone already

  expect_message([&] { calibration(camera(0), camera(0), "image_raw"); },
                 "/stereo/right/camera_info: the baseline is 0");
  EXPECT_FALSE(calibration({640, 480, "", {}, {}, {}, {}}, {640, 480, "", {}, {}, {}, {}}, "image_raw"));
}

TEST_F(BagSource, RejectsOtherFiles) {
  const std::string whole = path("whole.bag");
  BagWriter writer(whole);
  for (int i = 0; i < 20; ++i) {
    writer.write_image(left_topic, start_s + i, start_s + i, grey(i));
    writer.write_image(right_topic, start_s + i, start_s + i, grey(i));
  }
  writer.close();
  fs::copy_file(whole, path("cut.bag"));
  fs::resize_file(path("cut.bag"), fs::file_size(whole) / 2);
  expect_message([&] { open_bag(path("cut.bag"), {}); }, "rosbag reindex " + path("cut.bag"));
  std::ofstream(path("text.bag")) << "#ROSBAG it is not";
  expect_message([&] { open_bag(path("text.bag"), {}); }, "text.bag: this is not a readable ROS 1 bag");
  expect_message([&] { open_bag(path("none.bag"), {}); }, "none.bag: the file does not exist");
}

std::vector<BagTopic> images(const std::vector<std::string>& names) {
  std::vector<BagTopic> topics{{"/imu", "sensor_msgs/Imu"}};
  for (const std::string& name : names) {
    topics.push_back({name, name.ends_with("compressed") ? "sensor_msgs/CompressedImage" : "sensor_msgs/Image"});
  }
  return topics;
}

TEST(BagTopics, AreFoundByName) {
  const auto expect = [](const std::vector<std::string>& names, const std::string& left, const std::string& right) {
    const auto found = find_image_topics("x.bag", images(names), {});
    EXPECT_EQ(found.first.name, left);
    EXPECT_EQ(found.second.name, right);
  };
  expect({"/right/image", "/left/image"}, "/left/image", "/right/image");
  expect({"/cam1/image_raw", "/cam0/image_raw"}, "/cam0/image_raw", "/cam1/image_raw");
  expect({"/image_1", "/image_0"}, "/image_0", "/image_1");
  expect({"/left/image/compressed", "/left/image", "/right/image", "/right/image/compressed"}, "/left/image",
         "/right/image");
  expect({"/left/image/compressed", "/right/image/compressed", "/front/image"}, "/left/image/compressed",
         "/right/image/compressed");
}

TEST(BagTopics, AmbiguousNamesAreRejected) {
  const auto find = [](const std::vector<std::string>& names, const std::vector<std::string>& wanted = {}) {
    return find_image_topics("x.bag", images(names), wanted);
  };
  expect_message(
      [&] {
        find({"/a", "/b"});
      },
      "x.bag: no left and right camera can be recognised by the topic names; "
      "select two of its image topics with --topics LEFT,RIGHT: /a, /b");
  expect_message([&] { find({}); }, "LEFT,RIGHT: none");
  expect_message([&] { find({"/l/left", "/l/right", "/m/left", "/m/right"}); }, "more than one pair");
  expect_message([&] { find({"/a", "/b"}, {"/a", "/imu"}); }, "/imu is not an image topic of the bag");
  EXPECT_EQ(find({"/a", "/b"}, {"/b", "/a"}).first.name, "/b");
}

TEST(BagTopics, CameraInfoIsBesideImages) {
  EXPECT_EQ(camera_info_topic("/stereo/left/image_raw"), "/stereo/left/camera_info");
  EXPECT_EQ(camera_info_topic("/stereo/left/image_raw/compressed"), "/stereo/left/camera_info");
}

}  // namespace
