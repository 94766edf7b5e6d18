// Recordings as folders and lists: which images are a pair, in which order, and when they were taken.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "io/source/frame_times.hpp"
#include "io/source/pairing.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/io/frame_source.hpp"
#include "roadstereo/io/image_file.hpp"

namespace roadstereo::io {
namespace {

namespace fs = std::filesystem;

/// A small picture that holds one number.
Frame numbered(std::uint8_t number) {
  Frame frame;
  frame.width = frame.height = 32;
  frame.bytes.assign(32 * 32, number);
  frame.bytes[0] = static_cast<std::uint8_t>(number + 1);
  return frame;
}

class Sources : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ =
        fs::temp_directory_path() / (std::string("roadstereo_sources_") + test->name() + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  void image(const std::string& name, std::uint8_t number) const {
    const fs::path path = folder_ / name;
    fs::create_directories(path.parent_path());
    const std::vector<std::uint8_t> png = encode_png(numbered(number).view());
    std::ofstream(path, std::ios::binary).write(reinterpret_cast<const char*>(png.data()), std::ssize(png));
  }
  void text(const std::string& name, const std::string& content) const {
    fs::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name) << content;
  }

  std::vector<SourcePair> all(const std::string& name = ".", const SourceOptions& options = {}) const {
    const auto source = open_source({(folder_ / name).string()}, options);
    std::vector<SourcePair> pairs;
    while (auto pair = source->next()) pairs.push_back(std::move(*pair));
    EXPECT_EQ(source->size(), std::ssize(pairs));
    return pairs;
  }

  /// What opening it complains of.
  std::string complaint(const std::string& name, const SourceOptions& options = {}) const {
    try {
      open_source({(folder_ / name).string()}, options);
    } catch (const Error& error) {
      return error.what();
    }
    return {};
  }

  fs::path folder_;
};
using FolderSource = Sources;
using ListSource = Sources;
using OpenSource = Sources;

void expect_numbers(const SourcePair& pair, int left, int right) {
  EXPECT_EQ(pair.error, "");
  ASSERT_FALSE(pair.left.bytes.empty());
  EXPECT_EQ(pair.left.bytes[1], left);
  EXPECT_EQ(pair.right.bytes[1], right);
}

struct Layout {
  const char* left;
  const char* right;
};

class FolderLayout : public Sources, public testing::WithParamInterface<Layout> {};

TEST_P(FolderLayout, IsRecognisedAndInOrder) {
  const auto [left, right] = GetParam();
  for (const int number : {10, 2, 1}) {
    const std::string name = std::to_string(number) + ".png";
    image(left + name, static_cast<std::uint8_t>(number));
    image(right + name, static_cast<std::uint8_t>(100 + number));
  }
  const std::vector<SourcePair> pairs = all();
  ASSERT_EQ(pairs.size(), 3U);
  expect_numbers(pairs[0], 1, 101);
  expect_numbers(pairs[1], 2, 102);
  expect_numbers(pairs[2], 10, 110);
  EXPECT_EQ(pairs[2].index, 2);
  EXPECT_TRUE(std::isnan(pairs[2].time_s)) << "a number is not a time";
}

INSTANTIATE_TEST_SUITE_P(Known, FolderLayout,
                         testing::Values(Layout{"left/", "right/"}, Layout{"image_2/", "image_3/"},
                                         Layout{"image_0/", "image_1/"}, Layout{"image_02/data/", "image_03/data/"},
                                         Layout{"cam0/data/", "cam1/data/"}, Layout{"L", "R"}, Layout{"left", "right"},
                                         Layout{"left/left_", "right/right_"}));

TEST_F(FolderSource, EurocPairsByTime) {
  image("cam0/data/1403636579763555584.png", 1);
  image("cam1/data/1403636579763555584.png", 2);
  image("cam0/data/1403636579813555456.png", 3);
  image("cam1/data/1403636579823555456.png", 4);  // 10 ms later
  image("cam0/data/1403636579863555584.png", 5);
  image("cam1/data/1403636579864555584.png", 6);  // 1 ms later
  const std::vector<SourcePair> pairs = all();
  ASSERT_EQ(pairs.size(), 3U);
  expect_numbers(pairs[0], 1, 2);
  EXPECT_NEAR(pairs[0].time_s, 1403636579.763555584, 1e-6);
  EXPECT_NE(pairs[1].error.find("10 ms apart"), std::string::npos) << pairs[1].error;
  EXPECT_NE(pairs[1].error.find("5 ms"), std::string::npos) << pairs[1].error;
  expect_numbers(pairs[2], 5, 6);
  SourceOptions patient;
  patient.max_time_difference_s = 0.02;
  EXPECT_EQ(all(".", patient)[1].error, "");
}

TEST_F(FolderSource, RejectsImageWithoutPartnerOnly) {
  for (const char* name : {"1.png", "2.png", "3.png"}) image(std::string("left/") + name, 1);
  for (const char* name : {"1.png", "3.png", "4.png"}) image(std::string("right/") + name, 2);
  text("times.txt", "0.5\n1.5\n2.5\n");
  const std::vector<SourcePair> pairs = all();
  ASSERT_EQ(pairs.size(), 4U);
  EXPECT_EQ(pairs[0].error, "");
  EXPECT_NE(pairs[1].error.find("no right image"), std::string::npos) << pairs[1].error;
  EXPECT_NE(pairs[3].error.find("no left image"), std::string::npos) << pairs[3].error;
  EXPECT_EQ(pairs[1].time_s, 1.5);
  EXPECT_EQ(pairs[2].time_s, 2.5) << "times count left images";
  EXPECT_TRUE(std::isnan(pairs[3].time_s));
}

TEST_F(FolderSource, MissingTimeStampCostsOnePair) {
  for (int i = 0; i < 6; ++i) {
    const std::string name = "140363657" + std::to_string(i) + ".000000000.png";
    image("left/" + name, static_cast<std::uint8_t>(i));
    if (i != 2) image("right/" + name, static_cast<std::uint8_t>(i));
  }
  const std::vector<SourcePair> pairs = all();
  ASSERT_EQ(pairs.size(), 6U);
  for (int i = 0; i < 6; ++i) EXPECT_EQ(pairs[static_cast<std::size_t>(i)].error.empty(), i != 2) << i;
}

TEST_F(FolderSource, RejectsBrokenImageByNameOnly) {
  image("left/1.png", 1);
  image("right/1.png", 1);
  text("left/2.png", "no picture");
  image("right/2.png", 1);
  image("left/3.png", 1);
  image("right/3.png", 1);
  const std::vector<SourcePair> pairs = all();
  ASSERT_EQ(pairs.size(), 3U);
  EXPECT_NE(pairs[1].error.find("left/2.png"), std::string::npos) << pairs[1].error;
  EXPECT_EQ(pairs[2].error, "");
}

TEST_F(FolderSource, SkipsExactly) {
  for (std::uint8_t i = 0; i < 5; ++i) {
    image("L" + std::to_string(i) + ".png", i);
    image("R" + std::to_string(i) + ".png", i);
  }
  const auto source = open_source({folder_.string()});
  source->skip(3);
  const auto pair = source->next();
  ASSERT_TRUE(pair);
  EXPECT_EQ(pair->index, 3);
  expect_numbers(*pair, 3, 3);
  source->skip(100);
  EXPECT_FALSE(source->next());
}

TEST_F(FolderSource, PairsTwoFoldersByNumber) {
  image("a/front_0007.png", 7);
  image("b/rear-7.png", 8);
  const auto source = open_source({(folder_ / "a").string(), (folder_ / "b").string()});
  const auto pair = source->next();
  ASSERT_TRUE(pair);
  expect_numbers(*pair, 7, 8);
}

// Of several numbers in a name that counts which is not the same in all of them.
TEST_F(FolderSource, NumberOfFrameIsOneThatChanges) {
  for (const std::uint8_t i : {std::uint8_t{1}, std::uint8_t{2}, std::uint8_t{10}}) {
    const std::string name = "street_000003_" + std::to_string(i);
    image("a/" + name + "_leftImg8bit.png", i);
    image("b/" + name + "_rightImg8bit.png", i);
  }
  const auto source = open_source({(folder_ / "a").string(), (folder_ / "b").string()});
  for (const int i : {1, 2, 10}) {
    const auto pair = source->next();
    ASSERT_TRUE(pair);
    expect_numbers(*pair, i, i);
  }
}

// One name that looks like a time, wherever the file system lists it, does not make the others times.
TEST_F(FolderSource, OneNameLikeATimeChangesNothing) {
  image("a/front_7.png", 7);
  image("a/1700000000000000000.png", 1);
  image("b/rear-7.png", 8);
  image("b/1700000000000000001.png", 2);
  const auto source = open_source({(folder_ / "a").string(), (folder_ / "b").string()});
  const auto pair = source->next();
  ASSERT_TRUE(pair);
  expect_numbers(*pair, 7, 8);
}

TEST_F(FolderSource, TwoImagesOfOneFrameAreAnError) {
  image("left/1.png", 1);
  image("left/01.png", 1);
  image("right/1.png", 1);
  EXPECT_NE(complaint(".").find("one frame by their names"), std::string::npos) << complaint(".");
}

// As a shell completes them.
TEST_F(FolderSource, SlashBehindFolderChangesNothing) {
  image("left/1.png", 1);
  image("right/1.png", 2);
  text("times.txt", "0.5\n");
  text("calibration.yaml", "focal_px: 300\ncx_px: 15.5\ncy_px: 11.5\nbaseline_m: 0.12\n");
  const auto source = open_source({(folder_ / "left").string() + "/", (folder_ / "right").string() + "/"});
  EXPECT_EQ(source->description().substr(0, 22), "folders left and right") << source->description();
  EXPECT_FALSE(source->calibration_file().empty());
  EXPECT_EQ(source->next()->time_s, 0.5);
}

// Python's str(time.time()) has as many decimals as it needs.
TEST_F(FolderSource, TimesInNamesAreNumbers) {
  const char* const names[] = {"1700000000.0933876", "1700000000.1", "1700000000.700015", "1700000001.25"};
  for (std::uint8_t i = 0; i < 4; ++i) {
    image(std::string("left/") + names[i] + ".png", i);
    image(std::string("right/") + names[i] + ".png", i);
  }
  const std::vector<SourcePair> pairs = all();
  ASSERT_EQ(pairs.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) expect_numbers(pairs[i], static_cast<int>(i), static_cast<int>(i));
}

TEST_F(FolderSource, NanosecondsAreNoSeconds) {
  image("left/1.png", 1);
  image("right/1.png", 2);
  text("times.txt", "1403636579763555584\n");
  EXPECT_NE(complaint(".").find("not nanoseconds"), std::string::npos) << complaint(".");
}

/// synth and live --record write calibration.yaml beside the pictures.
TEST_F(FolderSource, TakesCalibrationBesideImages) {
  image("left/0.png", 0);
  image("right/0.png", 0);
  text("pairs.txt", "left/0.png right/0.png\n");
  for (const char* name : {"", "pairs.txt"}) EXPECT_FALSE(open_source({(folder_ / name).string()})->calibration());
  text("calibration.yaml", "focal_px: 300\ncx_px: 15.5\ncy_px: 11.5\nbaseline_m: 0.12\n");
  for (const char* name : {"", "pairs.txt"}) {
    const auto file = open_source({(folder_ / name).string()})->calibration();
    ASSERT_TRUE(file && file->rectified) << name;
    EXPECT_EQ(file->rectified->baseline_m, 0.12);
  }
  text("calibration.yaml", "focal_px: none\n");
  EXPECT_THROW(open_source({folder_.string()})->calibration(), Error);
}

TEST_F(ListSource, ReadsRelativePathsAndTimes) {
  image("x/one.png", 1);
  image("y/two.png", 2);
  text("pairs.txt", "# a comment\n\nx/one.png y/two.png 12.25\r\nx/one.png y/none.png\n");
  text("pairs.csv", "x/one.png, y/two.png ,3\n");
  const std::vector<SourcePair> pairs = all("pairs.txt");
  ASSERT_EQ(pairs.size(), 2U);
  expect_numbers(pairs[0], 1, 2);
  EXPECT_EQ(pairs[0].time_s, 12.25);
  EXPECT_NE(pairs[1].error.find("none.png"), std::string::npos);
  EXPECT_EQ(all("pairs.csv")[0].time_s, 3);
}

TEST_F(ListSource, ReadsSpreadsheetExports) {
  image("my x/one.png", 1);
  image("y/two.png", 2);
  text("table.csv", "\xEF\xBB\xBFleft,right,time\r\n\"my x/one.png\",\"y/two.png\",0.5\r\n");
  text("semicolon.csv", "my x/one.png; y/two.png; 1.5\n");
  text("quoted.txt", "\"my x/one.png\"  y/two.png\n");
  for (const char* name : {"table.csv", "semicolon.csv", "quoted.txt"}) {
    const std::vector<SourcePair> pairs = all(name);
    ASSERT_EQ(pairs.size(), 1U) << name;
    expect_numbers(pairs[0], 1, 2);
  }
  text("never.csv", "my x/one.png,y/two.png,nan\n");
  EXPECT_NE(complaint("never.csv").find("\"nan\" is not a time"), std::string::npos) << complaint("never.csv");
  text("nanoseconds.csv", "my x/one.png,y/two.png,1700000000000000000\n");
  EXPECT_NE(complaint("nanoseconds.csv").find("line 1: 1700000000000000000 is after the year 2100"), std::string::npos)
      << complaint("nanoseconds.csv");
}

TEST_F(OpenSource, ErrorNamesFileAndRemedy) {
  text("pairs.txt", "one.png\n");
  EXPECT_NE(complaint("pairs.txt").find("line 1"), std::string::npos);
  text("empty.txt", "# nothing\n");
  EXPECT_NE(complaint("empty.txt").find("the list has no pairs"), std::string::npos);
  EXPECT_NE(complaint("missing").find("no such file"), std::string::npos);
  fs::create_directories(folder_ / "hollow");
  EXPECT_NE(complaint("hollow").find("no stereo pairs"), std::string::npos);
  image("apart/left/one.png", 1);
  image("apart/right/two.png", 1);
  EXPECT_NE(complaint("apart").find("no names in common"), std::string::npos);
  text("apart/film.svo", "");
  EXPECT_NE(complaint("apart/film.svo").find("side-by-side video"), std::string::npos);
  SourceOptions backwards;
  backwards.rate_hz = -1;
  EXPECT_NE(complaint("pairs.txt", backwards).find("rate_hz is -1"), std::string::npos);
}

TEST_F(FolderSource, RecordingKilledInLastPairLosesThatOnly) {
  for (const char* name : {"left/0.png", "right/0.png", "left/1.png", "right/1.png", "left/2.png"}) image(name, 1);
  text("times.txt", "5\n6\n");
  for (const bool right_written : {false, true}) {
    if (right_written) image("right/2.png", 1);
    const auto source = open_source({folder_.string()});
    ASSERT_EQ(source->size(), 3);
    for (const double time_s : {5.0, 6.0}) {
      const auto pair = source->next();
      EXPECT_EQ(pair->error, "");
      EXPECT_EQ(pair->time_s, time_s);
    }
    EXPECT_NE(source->next()->error, "");
  }
}

/// What a power cut leaves: pairs whose times were not on the disk yet, and half a line.
TEST_F(FolderSource, PairsAfterLastWrittenTimeAreRejected) {
  for (int i = 1; i <= 5; ++i) {
    image("left/" + std::to_string(i) + ".png", 1);
    image("right/" + std::to_string(i) + ".png", 1);
  }
  for (const char* times :
       {"1795751061.5\n1795751061.6\n1795751061.7\n", "1795751061.5\n1795751061.6\n1795751061.7\n179575"}) {
    text("times.txt", times);
    const auto source = open_source({folder_.string()});
    ASSERT_EQ(source->size(), 5);
    for (int i = 0; i < 3; ++i) EXPECT_EQ(source->next()->error, "") << times;
    for (int i = 3; i < 5; ++i)
      EXPECT_NE(source->next()->error.find("the recording ended"), std::string::npos) << times;
  }
}

/// Times of all frames, and a picture that was deleted: numbers, or the other picture of the pair, tell which time.
TEST_F(FolderSource, MissingImageKeepsTimesOfOthers) {
  for (const char* number : {"000000", "000001", "000003"}) image(std::string("left/") + number + ".png", 1);
  for (const char* number : {"000000", "000001", "000003"}) image(std::string("right/") + number + ".png", 1);
  text("times.txt", "5\n6\n7\n8\n");
  const std::vector<SourcePair> gap = all();
  ASSERT_EQ(gap.size(), 3U);
  EXPECT_EQ(gap[1].time_s, 6);
  EXPECT_EQ(gap[2].time_s, 8);
  image("right/000002.png", 1);
  const std::vector<SourcePair> half = all();
  ASSERT_EQ(half.size(), 4U);
  EXPECT_NE(half[2].error, "");
  EXPECT_EQ(half[3].time_s, 8);
  text("times.txt", "5\n6\n7\n8\n9\n");  // of a frame before the first, or after the last?
  const std::string message = complaint(".");
  EXPECT_NE(message.find("has 5 times, but there are 3 left images; that of 000002 is missing; delete the lines"),
            std::string::npos)
      << message;
}

TEST_F(FolderSource, TimesDoNotRunBackwards) {
  for (const char* name : {"left/1.png", "right/1.png", "left/2.png", "right/2.png", "left/3.png", "right/3.png"}) {
    image(name, 1);
  }
  text("times.txt", "3\n2\n1\n");
  EXPECT_NE(complaint(".").find("2 lie before the one above, time 3 for example"), std::string::npos) << complaint(".");
  text("list.txt", "left/1.png right/1.png 7\nleft/2.png right/2.png 6\n");
  EXPECT_NE(complaint("list.txt").find("line 2: the time 6 lies before"), std::string::npos) << complaint("list.txt");
}

TEST_F(FolderSource, NamesOfFoldersMayBeUpperCase) {
  for (const char* name : {"a/Left/1.png", "a/RIGHT/1.png", "b/left/1.png", "c/view1.png", "c/view2.png"})
    image(name, 1);
  EXPECT_EQ(all("a").size(), 1U);
  EXPECT_NE(complaint("b").find("there is left/ but no right/"), std::string::npos) << complaint("b");
  EXPECT_NE(complaint("c").find("2 images in this folder do not tell left from right"), std::string::npos)
      << complaint("c");
  text("list.txt", "a b/1.png c d/1.png\n");
  EXPECT_NE(complaint("list.txt").find("4 words; put names with blanks in quotes"), std::string::npos);
}

TEST_F(FolderSource, RejectsOtherNumberOfTimes) {
  image("left/1.png", 1);
  image("right/1.png", 1);
  text("times.txt", "1\n2\n");
  EXPECT_NE(complaint(".").find("has 2 times, but there are 1"), std::string::npos) << complaint(".");
  for (const char* name : {"left/2.png", "right/2.png", "left/3.png", "right/3.png"}) image(name, 1);
  text("times.txt", "1\n");
  EXPECT_NE(complaint(".").find("has 1 times, but there are 3"), std::string::npos) << complaint(".");
  text("times.txt", "soon\n");
  EXPECT_NE(complaint(".").find("line 1: \"soon\""), std::string::npos) << complaint(".");
  SourceOptions ten_a_second;
  ten_a_second.rate_hz = 10;
  EXPECT_EQ(complaint(".", ten_a_second), "") << "a rate stands in the place of times";
}

TEST(FrameTimes, ParsesNamesAndDates) {
  EXPECT_NEAR(time_of_name("1403636579763555584").value(), 1403636579.763555584, 1e-6);
  EXPECT_NEAR(time_of_name("1403636579763").value(), 1403636579.763, 1e-6);
  EXPECT_NEAR(time_of_name("1403636579.25").value(), 1403636579.25, 1e-9);
  EXPECT_FALSE(time_of_name("000012"));
  EXPECT_FALSE(time_of_name("frame"));
  const fs::path file = fs::temp_directory_path() / ("roadstereo_times" + std::to_string(getpid()));
  std::ofstream(file) << "1970-01-02T00:00:00Z\n2011-09-26 13:02:25.964389445\n";
  const std::vector<double> times = read_times(file);
  EXPECT_EQ(times[0], 86400);
  EXPECT_NEAR(times[1], 1317042145.964389445, 1e-6);
  fs::remove(file);
}

TEST(Pairing, SortsNumbersNaturally) {
  EXPECT_TRUE(natural_less("frame2", "frame10"));
  EXPECT_FALSE(natural_less("frame10", "frame2"));
  EXPECT_FALSE(natural_less("007", "7"));
  EXPECT_FALSE(natural_less("7", "007"));
  EXPECT_TRUE(natural_less("a", "b1"));
  EXPECT_TRUE(natural_less("a", "a1"));
}

}  // namespace
}  // namespace roadstereo::io
