#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "evaluation/ply_read.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/io/point_cloud.hpp"

namespace {

using namespace roadstereo;
using namespace roadstereo::io;
namespace fs = std::filesystem;

class PlyFile : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    path_ = fs::temp_directory_path() / (std::string("roadstereo_ply_") + test->name() + std::to_string(getpid()));
  }
  void TearDown() override { fs::remove(path_); }

  PointCloud read(const std::string& bytes) const {
    std::ofstream(path_, std::ios::binary) << bytes;
    return read_ply(path_.string());
  }

  /// The complaint about a file with these bytes; it must name the file.
  std::string complaint(const std::string& bytes) const {
    try {
      read(bytes);
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(path_.string()), std::string::npos) << error.what();
      return error.what();
    }
    return "";
  }

  fs::path path_;
};

/// The bytes of a value, highest first.
template <class Value>
std::string big_endian(Value value) {
  std::string bytes(sizeof(Value), '\0');
  std::memcpy(bytes.data(), &value, sizeof(Value));
  if constexpr (std::endian::native == std::endian::little) bytes = {bytes.rbegin(), bytes.rend()};
  return bytes;
}

PointCloud example_cloud() {
  return {{{1.5F, -2.25F, 3e-8F}, {-1e6F, 0.1F, 7.0F}, {0, 0, 0}}, {{1, 2, 3}, {255, 0, 128}, {9, 8, 7}}};
}

std::string as_string(const std::vector<std::uint8_t>& bytes) {
  return {bytes.begin(), bytes.end()};
}

TEST_F(PlyFile, RoundTripIsExact) {
  const PointCloud cloud = example_cloud();
  const PointCloud back = read(as_string(encode_ply(cloud)));
  EXPECT_EQ(back.points, cloud.points);
  EXPECT_EQ(back.colours, cloud.colours);
}

TEST_F(PlyFile, RoundTripWithoutColours) {
  const PointCloud cloud{example_cloud().points, {}};
  const PointCloud back = read(as_string(encode_ply(cloud)));
  EXPECT_EQ(back.points, cloud.points);
  EXPECT_TRUE(back.colours.empty());
}

TEST_F(PlyFile, WritesBytesOfFormat) {
  const std::string header =
      "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n";
  const std::string data("\x00\x00\x80\x3f\x00\x00\x00\xc0\x00\x00\x00\x3f\x0a\x14\x1e", 15);  // 1, −2, 0.5; 10, 20, 30
  EXPECT_EQ(as_string(encode_ply({{{1, -2, 0.5F}}, {{10, 20, 30}}})), header + data);
}

TEST_F(PlyFile, RejectsOtherNumberOfColours) {
  EXPECT_THROW(encode_ply({{{1, 2, 3}}, {{1, 2, 3}, {4, 5, 6}}}), Error);
}

TEST_F(PlyFile, ReadsAsciiWithFacesBeforeAndAfter) {
  const PointCloud cloud = read(
      "ply\r\nformat ascii 1.0\r\ncomment element vertex 99\r\nelement face 2\r\nproperty list uchar int "
      "vertex_indices\r\nelement vertex 2\r\nproperty ushort blue\r\nproperty double z\r\nproperty list uchar float "
      "weights\r\nproperty float red\r\nproperty int x\r\nproperty char y\r\nproperty uchar green\r\nelement edge "
      "1\r\nproperty int a\r\nend_header\r\n3 0 1 1\r\n0\r\n65535 1.5 2 0.1 0.2 1.0 -7 -3 128\r\n0 +2.5 0 0 8 4 "
      "7\r\n5");
  const std::vector<std::array<float, 3>> points{{-7, -3, 1.5F}, {8, 4, 2.5F}};
  const std::vector<std::array<std::uint8_t, 3>> colours{{255, 128, 255}, {0, 7, 0}};
  EXPECT_EQ(cloud.points, points);
  EXPECT_EQ(cloud.colours, colours);
}

TEST_F(PlyFile, ReadsBigEndian) {
  const PointCloud cloud = read(
      "ply\nformat binary_big_endian 1.0\nelement range_grid 1\nproperty list int short i\nelement vertex 1\n"
      "property double z\nproperty float x\nproperty short y\nend_header\n" +
      big_endian(std::int32_t{2}) + big_endian(std::int16_t{1}) + big_endian(std::int16_t{2}) + big_endian(3.25) +
      big_endian(1.5F) + big_endian(std::int16_t{-300}));
  ASSERT_EQ(cloud.points.size(), 1U);
  EXPECT_EQ(cloud.points[0], (std::array<float, 3>{1.5F, -300, 3.25F}));
  EXPECT_TRUE(cloud.colours.empty());
}

TEST_F(PlyFile, SkipsVerticesThatAreNotFinite) {
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty uchar "
      "red\nproperty uchar green\nproperty uchar blue\nend_header\n";
  const PointCloud cloud = read(header + "nan 0 0 1 1 1\n1 2 3 4 5 6\n1e999 0 0 7 7 7\n");
  ASSERT_EQ(cloud.points.size(), 1U);
  ASSERT_EQ(cloud.colours.size(), 1U);
  EXPECT_EQ(cloud.colours[0][0], 4);
  EXPECT_NE(complaint(header + "nan 0 0 1 1 1\ninf 2 3 4 5 6\n-inf 0 0 7 7 7\n").find("finite"), std::string::npos);
}

TEST_F(PlyFile, RejectsHeadersThatLie) {
  const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
  const std::string binary = "ply\nformat binary_little_endian 1.0\n";
  const std::vector<std::array<std::string, 2>> cases{
      {"plyx\nformat ascii 1.0\n", "start with"},
      {std::string(100, 'a'), "not a PLY"},
      {"ply\nformat ascii 1.0\nelement vertex 1\n" + xyz, "does not end"},
      {"ply\nelement vertex 1\n" + xyz + "end_header\n0 0 0\n", "format"},
      {"ply\nformat binary_middle_endian 1.0\nend_header\n", "binary_little_endian"},
      {binary + "element vertex -5\n" + xyz + "end_header\n", "integer"},
      {binary + "element vertex 99999999999999999999999\n" + xyz + "end_header\n", "integer"},
      {binary + "element vertex 4611686018427387904\n" + xyz + "end_header\n" + std::string(24, 'a'), "truncated"},
      {binary + "element vertex 3\n" + xyz + "end_header\n" + std::string(35, 'a'), "truncated"},
      {binary + "element vertex 1\nproperty float x\nproperty float y\nend_header\n12345678", "\"z\""},
      {binary + "element vertex 1\nproperty float x\nproperty float x\nend_header\n12345678", "repeated"},
      {binary + "element vertex 1\nproperty quad x\nend_header\n", "type"},
      {binary + "property float x\nend_header\n", "follow an element"},
      {binary + "element vertex 1\nproperty list float int x\nend_header\n", "integer type"},
      {binary + "element face 1\nproperty list int int i\nelement vertex 1\n" + xyz + "end_header\n\xff\xff\xff\xff" +
           std::string(20, 'a'),
       "entries"},
      {binary + "element face 1\nproperty list int int i\nelement vertex 1\n" + xyz + "end_header\n\xff\xff\xff\x7f" +
           std::string(20, 'a'),
       "truncated"},
      {"ply\nformat ascii 1.0\nelement vertex 1\n" + xyz + "end_header\n0 zero 0\n", "zero"},
      {"ply\nformat ascii 1.0\nelement vertex 2\n" + xyz + "end_header\n0 1 2\n3 4\n", "truncated"},
      {binary + "element face 0\nproperty list uchar int i\nend_header\n", "vertex"},
      {binary + "elephant\nend_header\n", "elephant"}};
  for (const auto& [bytes, part] : cases) {
    const std::string said = complaint(bytes);
    EXPECT_NE(said.find(part), std::string::npos) << "\"" << part << "\" in: " << said;
  }
}

TEST_F(PlyFile, ErrorNamesMissingFile) {
  try {
    read_ply("/no/such/cloud.ply");
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("/no/such/cloud.ply"), std::string::npos);
  }
}

TEST_F(PlyFile, RejectsEveryTruncation) {
  const std::string whole = as_string(encode_ply(example_cloud()));
  for (std::size_t bytes = 1; bytes < whole.size(); ++bytes) EXPECT_NE(complaint(whole.substr(0, bytes)), "") << bytes;
}

/// The scans of the pothole data: sizes as their headers say, millimetres.
TEST(PlyFileRealData, ReadsLaserScan) {
  const char* data = std::getenv("ROADSTEREO_DATA");
  const fs::path scan = fs::path(data == nullptr ? "" : data) / "potholes/scan/p1_scan1.ply";
  if (!fs::exists(scan)) GTEST_SKIP() << "no laser scans: set ROADSTEREO_DATA";
  const PointCloud cloud = read_ply(scan.string());
  ASSERT_EQ(cloud.points.size(), 256969U);
  ASSERT_EQ(cloud.colours.size(), cloud.points.size());
  for (const auto& point : cloud.points) {
    for (const float x : point) ASSERT_LT(std::abs(x), 100);
  }
}

}  // namespace
