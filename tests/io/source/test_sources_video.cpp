#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "io/frame_mat.hpp"
#include "io/source/sources.hpp"
#include "io/source/split_views.hpp"
#include "roadstereo/error.hpp"

namespace {

namespace fs = std::filesystem;
using namespace roadstereo;
using namespace roadstereo::io;

constexpr int view_width = 96;
constexpr int view_height = 64;
constexpr int bit_side = 16;  // blocks of a codec: a bit each
constexpr int bits = 5;

/// A view that says which it is: its number in black and white blocks, its side in the colour below.
cv::Mat view_of(int number, bool right) {
  cv::Mat view(view_height, view_width, CV_8UC3, right ? cv::Scalar(40, 90, 200) : cv::Scalar(200, 90, 40));
  for (int bit = 0; bit < bits; ++bit) {
    const cv::Rect block(bit * bit_side, 0, bit_side, bit_side);
    view(block).setTo(cv::Scalar::all((number >> bit) % 2 == 1 ? 255 : 0));
  }
  return view;
}

int sample(const Frame& frame, int u, int v, int channel) {
  const int channels = channel_count(frame.order);
  return frame.bytes.at(static_cast<std::size_t>((v * frame.width + u) * channels + channel));
}

int number_in(const Frame& frame) {
  int number = 0;
  for (int bit = 0; bit < bits; ++bit) {
    const int level = sample(frame, bit * bit_side + bit_side / 2, bit_side / 2, 0);
    number |= (level > 127 ? 1 : 0) << bit;
  }
  return number;
}

bool is_right(const Frame& frame) {
  return sample(frame, view_width / 2, view_height - 8, 0) < sample(frame, view_width / 2, view_height - 8, 2);
}

void expect_pair(const std::optional<SourcePair>& pair, int number) {
  ASSERT_TRUE(pair) << "pair " << number;
  EXPECT_EQ(pair->error, "");
  EXPECT_EQ(pair->index, number);
  ASSERT_EQ(pair->left.width, view_width);
  ASSERT_EQ(pair->left.height, view_height);
  ASSERT_EQ(pair->right.width, view_width);
  ASSERT_EQ(pair->right.height, view_height);
  EXPECT_EQ(number_in(pair->left), number);
  EXPECT_EQ(number_in(pair->right), number);
  EXPECT_FALSE(is_right(pair->left));
  EXPECT_TRUE(is_right(pair->right));
}

cv::Mat beside(int number) {
  cv::Mat picture;
  cv::hconcat(view_of(number, false), view_of(number, true), picture);
  return picture;
}

cv::Mat above(int number) {
  cv::Mat picture;
  cv::vconcat(view_of(number, false), view_of(number, true), picture);
  return picture;
}

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

class VideoSource : public testing::Test {
 protected:
  VideoSource() {
    std::string name = (fs::temp_directory_path() / "roadstereo-video-XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
  }
  ~VideoSource() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  /// The pictures 0 … count − 1 as a video of that codec and rate; an empty name where OpenCV cannot write it.
  std::string write(const std::string& name, const char* codec, int count, const std::function<cv::Mat(int)>& picture,
                    double rate_hz = 25) const {
    const cv::Mat first = picture(0);
    cv::VideoWriter writer(path(name), cv::CAP_FFMPEG, cv::VideoWriter::fourcc(codec[0], codec[1], codec[2], codec[3]),
                           rate_hz, first.size(), first.channels() == 3);
    if (!writer.isOpened()) return "";
    for (int i = 0; i < count; ++i) writer.write(picture(i));
    return path(name);
  }

  std::string cut(const std::string& whole, const std::string& name, double share) const {
    fs::copy_file(whole, path(name));
    fs::resize_file(path(name), static_cast<std::uintmax_t>(share * static_cast<double>(fs::file_size(whole))));
    return path(name);
  }

 private:
  fs::path folder_;
};

#define NEEDS_CODEC(file) \
  if ((file).empty()) GTEST_SKIP() << "OpenCV cannot write this video here: not tested"

TEST(VideoLayout, FollowsShape) {
  const auto layout = [](int width, int height) { return find_layout("x", width, height, StereoLayout::automatic); };
  for (const auto& [width, height] : std::vector<std::pair<int, int>>{
           {2560, 720}, {1280, 360}, {3840, 1080}, {4416, 1242}, {1344, 376}, {1280, 480}, {2560, 1024}}) {
    EXPECT_EQ(layout(width, height), StereoLayout::side_by_side) << width << "×" << height;
  }
  for (const auto& [width, height] :
       std::vector<std::pair<int, int>>{{1280, 1440}, {640, 720}, {1920, 2160}, {640, 960}}) {
    EXPECT_EQ(layout(width, height), StereoLayout::top_bottom) << width << "×" << height;
  }
}

TEST(VideoLayout, RejectsAmbiguousShape) {
  for (const auto& [width, height] : std::vector<std::pair<int, int>>{{1920, 1080}, {640, 480}, {2484, 375}}) {
    expect_message([w = width, h = height] { find_layout("film.mp4", w, h, StereoLayout::automatic); },
                   "--layout side-by-side");
  }
  expect_message([] { find_layout("film.mp4", 1281, 360, StereoLayout::side_by_side); }, "1281 pixels wide");
  expect_message([] { find_layout("film.mp4", 640, 721, StereoLayout::top_bottom); }, "721 pixels high");
  EXPECT_EQ(find_layout("x", 1281, 360, StereoLayout::top_bottom), StereoLayout::top_bottom);
}

TEST_F(VideoSource, RoundTripsViews) {
  const std::string file = write("beside.mkv", "FFV1", 6, beside);  // lossless
  NEEDS_CODEC(file);
  const auto source = open_video(file, {});
  EXPECT_EQ(source->size(), 6);
  EXPECT_FALSE(source->live());
  for (int i = 0; i < 6; ++i) {
    const std::optional<SourcePair> pair = source->next();
    expect_pair(pair, i);
    EXPECT_EQ(pair->name, "00000" + std::to_string(i));
    EXPECT_NEAR(pair->time_s, i / 25.0, 1e-9);
    ASSERT_EQ(pair->left.order, ChannelOrder::bgr);
    EXPECT_EQ(cv::norm(mat_over(pair->left.view()), view_of(i, false), cv::NORM_INF), 0);
    EXPECT_EQ(cv::norm(mat_over(pair->right.view()), view_of(i, true), cv::NORM_INF), 0);
  }
  EXPECT_FALSE(source->next());
  EXPECT_FALSE(source->next());
}

TEST_F(VideoSource, SplitsViewsOneAboveOther) {
  const std::string file = write("above.avi", "MJPG", 3, above);
  NEEDS_CODEC(file);
  SourceOptions options;
  options.rate_hz = 10;
  const auto source = open_video(file, options);
  EXPECT_EQ(source->description(), "video, 3 pairs of 96×128 one above the other");
  for (int i = 0; i < 3; ++i) {
    const std::optional<SourcePair> pair = source->next();
    expect_pair(pair, i);
    EXPECT_NEAR(pair->time_s, i / 10.0, 1e-9);
  }
  EXPECT_FALSE(source->next());
}

TEST_F(VideoSource, GivenLayoutWins) {
  const std::string file = write("above.avi", "MJPG", 2, above);
  NEEDS_CODEC(file);
  SourceOptions options;
  options.layout = StereoLayout::side_by_side;
  const std::optional<SourcePair> pair = open_video(file, options)->next();
  ASSERT_TRUE(pair);
  EXPECT_EQ(pair->left.width, view_width / 2);
  EXPECT_EQ(pair->left.height, 2 * view_height);
}

TEST_F(VideoSource, RejectsVideoOfOneCamera) {
  const std::string file = write("one.avi", "MJPG", 2, [](int i) { return view_of(i, false); });
  NEEDS_CODEC(file);
  expect_message([&] { open_video(file, {}); }, "--layout");
}

TEST_F(VideoSource, KeepsGrey) {
  const auto grey = [](int i) {
    cv::Mat picture(view_height, 2 * view_width, CV_8UC1);
    for (int u = 0; u < picture.cols; ++u) picture.col(u).setTo(u + i);
    return picture;
  };
  const std::string file = write("grey.mkv", "FFV1", 3, grey);
  NEEDS_CODEC(file);
  const auto source = open_video(file, {});
  for (int i = 0; i < 3; ++i) {
    const std::optional<SourcePair> pair = source->next();
    ASSERT_TRUE(pair);
    ASSERT_EQ(pair->right.order, ChannelOrder::grey);
    for (int u = 0; u < view_width; ++u) {
      EXPECT_EQ(sample(pair->left, u, 5, 0), u + i);
      EXPECT_EQ(sample(pair->right, u, 5, 0), view_width + u + i);
    }
  }
}

TEST_F(VideoSource, SkipsExactlyBetweenKeyFrames) {
  const std::string file = write("predicted.mp4", "mp4v", 30, beside);  // a key frame in twelve
  NEEDS_CODEC(file);
  const auto source = open_video(file, {});
  source->skip(17);
  expect_pair(source->next(), 17);
  source->skip(0);
  expect_pair(source->next(), 18);
  source->skip(10);
  expect_pair(source->next(), 29);
  source->skip(5);
  EXPECT_FALSE(source->next());
}

TEST_F(VideoSource, UndecodableFrameCostsOnePair) {
  const std::string file = write("beside.avi", "MJPG", 6, beside);
  NEEDS_CODEC(file);
  std::fstream bytes(file, std::ios::in | std::ios::out | std::ios::binary);
  std::string content{std::istreambuf_iterator<char>(bytes), {}};
  std::size_t picture = 0;
  for (int i = 0; i < 3; ++i) picture = content.find("\xFF\xD8\xFF", picture + 1);  // the third JPEG
  ASSERT_NE(picture, std::string::npos);
  bytes.clear();
  bytes.seekp(static_cast<std::streamoff>(picture));
  bytes << std::string(300, '\0') << std::flush;
  bytes.close();
  const auto source = open_video(file, {});
  for (int i = 0; i < 6; ++i) {
    const std::optional<SourcePair> pair = source->next();
    if (i != 2) {
      expect_pair(pair, i);
      continue;
    }
    ASSERT_TRUE(pair);
    EXPECT_EQ(pair->index, 2);
    EXPECT_NE(pair->error.find("cannot be decoded"), std::string::npos) << pair->error;
  }
  EXPECT_FALSE(source->next());
  const auto again = open_video(file, {});
  again->skip(4);
  expect_pair(again->next(), 4);
}

TEST_F(VideoSource, ReportsMissingEndOfCutVideo) {
  const std::string whole = write("whole.mkv", "FFV1", 30, beside);
  NEEDS_CODEC(whole);
  const auto source = open_video(cut(whole, "cut.mkv", 0.6), {});
  int good = 0;
  std::optional<SourcePair> pair = source->next();
  for (; pair && pair->error.empty(); pair = source->next()) expect_pair(pair, good++);
  EXPECT_GT(good, 10);
  EXPECT_LT(good, 20);
  ASSERT_TRUE(pair) << "the end went unnoticed";
  EXPECT_EQ(pair->index, good);
  EXPECT_NE(pair->error.find(std::to_string(30 - good) + " frames before its stated length of 30"), std::string::npos)
      << pair->error;
  EXPECT_FALSE(source->next());
}

TEST_F(VideoSource, RejectsOtherFiles) {
  const std::string whole = write("whole.mp4", "mp4v", 30, beside);
  NEEDS_CODEC(whole);
  expect_message([&] { open_video(cut(whole, "cut.mp4", 0.5), {}); }, "cut.mp4: the video cannot be opened");
  std::ofstream(path("text.mp4")) << "this is a text, and no video, however long it may be";
  expect_message([&] { open_video(path("text.mp4"), {}); }, "text.mp4: the video cannot be opened");
  std::ofstream(path("empty.mp4")).flush();
  expect_message([&] { open_video(path("empty.mp4"), {}); }, "empty.mp4: the file is empty");
  expect_message([&] { open_video(path("none.mp4"), {}); }, "none.mp4: the file does not exist");
}

TEST_F(VideoSource, PairsTwoVideosByNumber) {
  const std::string left = write("left.avi", "MJPG", 4, [](int i) { return view_of(i, false); });
  NEEDS_CODEC(left);
  const std::string right = write("right.avi", "MJPG", 7, [](int i) { return view_of(i, true); });
  const auto source = open_two_videos(left, right, {});
  EXPECT_EQ(source->size(), 7);
  EXPECT_EQ(source->description(), "two videos, 7 pairs of 96×64");
  source->skip(1);
  for (int i = 1; i < 4; ++i) expect_pair(source->next(), i);
  for (int i = 4; i < 7; ++i) {
    const std::optional<SourcePair> pair = source->next();
    ASSERT_TRUE(pair);
    EXPECT_EQ(pair->index, i);
    EXPECT_NEAR(pair->time_s, i / 25.0, 1e-9);
    EXPECT_EQ(pair->error, left + " has ended after 4 frames");
  }
  EXPECT_FALSE(source->next());
}

TEST_F(VideoSource, RejectsTwoVideosThatDiffer) {
  const std::string left = write("left.avi", "MJPG", 2, [](int i) { return view_of(i, false); });
  NEEDS_CODEC(left);
  const std::string small =
      write("small.avi", "MJPG", 2, [](int i) -> cv::Mat { return view_of(i, true).rowRange(0, 48); });
  expect_message([&] { open_two_videos(left, small, {}); }, "small.avi: the video has 96×48 pixels");
  const std::string slow = write(
      "slow.avi", "MJPG", 2, [](int i) { return view_of(i, true); }, 20);
  expect_message([&] { open_two_videos(left, slow, {}); }, "slow.avi: the video has 20 frames per second");
  SourceOptions options;
  options.rate_hz = 25;
  expect_pair(open_two_videos(left, slow, options)->next(), 0);
}

class GStreamerSource : public testing::Test {
 protected:
  void SetUp() override {
    const std::string message = message_of([] { open_gstreamer("videotestsrc num-buffers=1 ! identity", {}); });
    if (message.find("no element") != std::string::npos || message.find("without GStreamer") != std::string::npos) {
      GTEST_SKIP() << "GStreamer or its base plugins are missing: not tested: " << message;
    }
  }
};

TEST_F(GStreamerSource, ReadsEveryFrameOfFinitePipeline) {
  // Its colours are known: the picture is red.
  const auto source = open_gstreamer(
      "videotestsrc num-buffers=5 pattern=solid-color foreground-color=0xffff0000 ! "
      "video/x-raw,format=BGRx,width=192,height=64",
      {});
  EXPECT_FALSE(source->live());
  EXPECT_FALSE(source->size());
  for (int i = 0; i < 5; ++i) {
    const std::optional<SourcePair> pair = source->next();
    ASSERT_TRUE(pair) << i;
    EXPECT_EQ(pair->error, "");
    EXPECT_EQ(pair->index, i);
    ASSERT_EQ(pair->left.width, view_width);
    ASSERT_EQ(pair->right.height, view_height);
    EXPECT_EQ(sample(pair->right, 40, 30, 0), 0);
    EXPECT_EQ(sample(pair->right, 40, 30, 2), 255);
    EXPECT_NEAR(pair->time_s, i / 30.0, 1e-3) << "the pictures' own times";
  }
  EXPECT_FALSE(source->next());
}

TEST_F(GStreamerSource, RateReplacesTimesOfRecording) {
  SourceOptions options;
  options.rate_hz = 4;
  const auto source = open_gstreamer("videotestsrc num-buffers=3 ! video/x-raw,width=192,height=64", options);
  for (int i = 0; i < 3; ++i) EXPECT_DOUBLE_EQ(source->next().value().time_s, i / 4.0);
}

TEST_F(GStreamerSource, TakesGreyAndUsersSink) {
  const auto source = open_gstreamer(
      "videotestsrc num-buffers=2 pattern=white ! video/x-raw,format=GRAY8,width=100,height=128 ! appsink sync=false",
      {});
  source->skip(1);
  const std::optional<SourcePair> pair = source->next();
  ASSERT_TRUE(pair);
  EXPECT_EQ(pair->index, 1);
  EXPECT_EQ(pair->left.order, ChannelOrder::grey);
  EXPECT_EQ(pair->left.width, 100);  // rows are padded to 4 bytes, halves are one above the other
  EXPECT_EQ(pair->left.height, 64);
  EXPECT_GT(sample(pair->right, 99, 63, 0), 230);
}

TEST_F(GStreamerSource, LivePipelineHasCaptureTimes) {
  SourceOptions options;
  options.rate_hz = 4;  // replaces only the times of recordings
  const auto source = open_gstreamer(
      "videotestsrc is-live=true num-buffers=4 ! video/x-raw,width=192,height=64,framerate=50/1", options);
  EXPECT_TRUE(source->live());
  int pairs = 0;
  double last_s = 1.6e9;
  while (const std::optional<SourcePair> pair = source->next()) {
    EXPECT_EQ(pair->error, "");
    EXPECT_EQ(pair->left.width, view_width);
    EXPECT_GT(pair->time_s, last_s);
    last_s = pair->time_s;
    ++pairs;
  }
  EXPECT_GE(pairs, 1);  // the sink drops what nobody takes
  EXPECT_LE(pairs, 4);
}

TEST_F(GStreamerSource, PassesErrorsOn) {
  expect_message([] { open_gstreamer("nosuchsource ! videoconvert", {}); },
                 "\"nosuchsource ! videoconvert\" is rejected by GStreamer: no element \"nosuchsource\"");
  expect_message([] { open_gstreamer("filesrc location=/none.raw ! rawvideoparse width=192 height=64", {}); },
                 "has failed: filesrc");
  expect_message(
      [] {
        const auto source = open_gstreamer(
            "videotestsrc ! video/x-raw,width=192,height=64 ! identity error-after=3 ! appsink sync=false", {});
        while (source->next()) {
        }
      },
      "has failed: identity");
}

// Pictures from a camera need a camera: only what goes wrong is tested.
TEST(CameraSource, ErrorSaysWhyThereIsNone) {
  expect_message([] { open_camera("/dev/video-none", {}); }, "/dev/video-none: there is no such camera");
  expect_message([] { open_camera("/dev/null", {}); }, "/dev/null: this is not a camera");
  expect_message([] { open_camera("/proc/self/stat", {}); }, "/proc/self/stat: this is a file, not a camera");
}

}  // namespace
