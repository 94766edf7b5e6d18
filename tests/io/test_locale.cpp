// Files are the same under any locale of the program that writes them.

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <locale>
#include <string>

#include "io/geo/utc_time.hpp"
#include "roadstereo/io/map_points.hpp"

namespace roadstereo {
namespace {

/// 12.345,6
class Grouping : public std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

class GroupedDigits : public testing::Test {
 protected:
  void SetUp() override { before_ = std::locale::global(std::locale(std::locale::classic(), new Grouping)); }
  void TearDown() override { std::locale::global(before_); }

  std::locale before_;
};

TEST_F(GroupedDigits, PointsAreCountedWithoutSeparators) {
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("roadstereo_locale" + std::to_string(::getpid()) + ".ply");
  const MapBox bounds{0, 0, 50, 40};
  io::write_map_points(file, bounds, {.cell_m = 0.01, .crs = ""}, [](const MapBox& box) {
    MapRaster raster;
    raster.box = box;
    raster.height = Image<float>(box.columns, box.rows);
    raster.sigma = Image<float>(box.columns, box.rows);
    raster.colour = Image<std::array<std::uint8_t, 3>>(box.columns, box.rows);
    raster.views.assign(box.columns, box.rows, 1);
    return raster;
  });
  std::ifstream stream(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  EXPECT_NE(text.find("element vertex 2000\n"), std::string::npos) << text.substr(0, 80);
  std::filesystem::remove(file);
}

TEST_F(GroupedDigits, YearsHaveNoSeparators) {
  io::UtcTime time;
  time.year = 2026;
  time.month = 3;
  time.day = 1;
  time.millisecond = 7005;
  EXPECT_EQ(io::iso_text(time), "2026-03-01T00:00:07.005Z");
}

}  // namespace
}  // namespace roadstereo
