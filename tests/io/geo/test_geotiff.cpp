// Rasters of maps, read back with GDAL.

#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <ogr_spatialref.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "roadstereo/error.hpp"
#include "roadstereo/io/geotiff.hpp"
#include "roadstereo/io/map_points.hpp"

namespace roadstereo::io {
namespace {

namespace fs = std::filesystem;

constexpr MapBox bounds{-300, 40, 1100, 700};  // more than one tile of a raster, in both directions

double height_at(int i, int j) {
  return 0.001 * i - 0.002 * j;
}

/// Cells of a map without the ones left of column −200.
MapRaster read_cells(const MapBox& box) {
  MapRaster raster;
  raster.box = box;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  raster.height.assign(box.columns, box.rows, nan);
  raster.sigma.assign(box.columns, box.rows, nan);
  raster.colour.assign(box.columns, box.rows, {0, 0, 0});
  raster.views.assign(box.columns, box.rows, 0);
  for (int v = 0; v < box.rows; ++v) {
    for (int u = 0; u < box.columns; ++u) {
      const int i = box.i0 + u, j = box.j0 + box.rows - 1 - v;
      if (i < -200) continue;
      raster.height(u, v) = static_cast<float>(height_at(i, j));
      raster.sigma(u, v) = 0.003F;
      raster.colour(u, v) = {200, 100, 50};
      raster.views(u, v) = static_cast<std::uint16_t>(j);
    }
  }
  return raster;
}

class GeoTiffTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() /
              (std::string("roadstereo_tiff_") + testing::UnitTest::GetInstance()->current_test_info()->name() +
               std::to_string(::getpid()));
    fs::create_directories(folder_);
    GDALAllRegister();
  }
  void TearDown() override { fs::remove_all(folder_); }

  GDALDatasetUniquePtr written(MapLayer layer, const MapReference& reference) const {
    const std::string file = (folder_ / "map.tif").string();
    write_geotiff(file, layer, bounds, reference, read_cells);
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1);  // no scratch file
    return GDALDatasetUniquePtr(GDALDataset::Open(file.c_str(), GDAL_OF_RASTER));
  }

  fs::path folder_;
};

TEST_F(GeoTiffTest, HeightsLieWhereTheirCellsAre) {
  const auto dataset = written(MapLayer::height, {0.02, 500000, 5400000, 100, "EPSG:32632"});
  ASSERT_NE(dataset, nullptr);
  EXPECT_STREQ(dataset->GetMetadataItem("LAYOUT", "IMAGE_STRUCTURE"), "COG");
  std::array<double, 6> transform{};
  ASSERT_EQ(dataset->GetGeoTransform(transform.data()), CE_None);
  const std::array<double, 6> expected{500000 - 300 * 0.02, 0.02, 0, 5400000 + 740 * 0.02, 0, -0.02};
  for (std::size_t k = 0; k < 6; ++k) EXPECT_NEAR(transform[k], expected[k], 1e-6);
  ASSERT_NE(dataset->GetSpatialRef(), nullptr);
  EXPECT_EQ(dataset->GetSpatialRef()->GetUTMZone(), 32);
  EXPECT_GE(dataset->GetRasterBand(1)->GetOverviewCount(), 1);
  std::vector<float> row(bounds.columns);
  for (const int v : {0, 511, 512, 699}) {
    ASSERT_EQ(dataset->GetRasterBand(1)->RasterIO(GF_Read, 0, v, bounds.columns, 1, row.data(), bounds.columns, 1,
                                                  GDT_Float32, 0, 0, nullptr),
              CE_None);
    const int j = 40 + 699 - v;
    EXPECT_TRUE(std::isnan(row[99]));
    for (const int u : {100, 511, 512, 1099})
      EXPECT_NEAR(row[static_cast<std::size_t>(u)], 100 + height_at(u - 300, j), 1e-4);
  }
}

TEST_F(GeoTiffTest, OrthophotoHasColoursAndMask) {
  const auto dataset = written(MapLayer::orthophoto, {0.02, 0, 0, 0, ""});
  ASSERT_NE(dataset, nullptr);
  ASSERT_GE(dataset->GetRasterCount(), 3);
  std::array<std::uint8_t, 3> pixel{};
  ASSERT_EQ(dataset->RasterIO(GF_Read, 700, 300, 1, 1, pixel.data(), 1, 1, GDT_Byte, 3, nullptr, 0, 0, 0, nullptr),
            CE_None);
  EXPECT_NEAR(pixel[0], 200, 3);  // JPEG
  EXPECT_NEAR(pixel[1], 100, 3);
  EXPECT_NEAR(pixel[2], 50, 3);
  const auto mask = [&](int u) {
    std::uint8_t value = 77;
    EXPECT_EQ(dataset->GetRasterBand(1)->GetMaskBand()->RasterIO(GF_Read, u, 300, 1, 1, &value, 1, 1, GDT_Byte, 0, 0,
                                                                 nullptr),
              CE_None);
    return value;
  };
  EXPECT_EQ(mask(20), 0);
  EXPECT_EQ(mask(700), 255);
  ASSERT_NE(dataset->GetSpatialRef(), nullptr);
  EXPECT_TRUE(dataset->GetSpatialRef()->IsLocal());
  EXPECT_NEAR(dataset->GetSpatialRef()->GetLinearUnits(), 1, 1e-12);
}

TEST_F(GeoTiffTest, RejectsEmptyMapsAndUnknownCoordinateSystems) {
  const std::string file = (folder_ / "map.tif").string();
  EXPECT_THROW(write_geotiff(file, MapLayer::height, {}, {0.02, 0, 0, 0, ""}, read_cells), Error);
  EXPECT_THROW(write_geotiff(file, MapLayer::height, bounds, {0.02, 0, 0, 0, "EPSG:nonsense"}, read_cells), Error);
  // Feet of New York; metres towards west and south of South Africa.
  for (const char* crs : {"EPSG:2263", "EPSG:2048"}) {
    EXPECT_THROW(write_geotiff(file, MapLayer::height, bounds, {0.02, 0, 0, 0, crs}, read_cells), Error) << crs;
  }
  EXPECT_THROW(write_geotiff(folder_ / "none" / "map.tif", MapLayer::height, bounds, {0.02, 0, 0, 0, ""}, read_cells),
               SystemError);
}

// Pixel (700, 300) is cell (400, 439), 0.001 · 400 − 0.002 · 439 m high; left of column 100 nothing is measured. Only
// heights are those above the reference.
TEST_F(GeoTiffTest, EveryLayerHasItsValues) {
  struct Case {
    MapLayer layer;
    GDALDataType type;
    double value, empty;
  };
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Case& expected :
       {Case{MapLayer::height, GDT_Float32, 100 - 0.478, nan}, Case{MapLayer::sigma, GDT_Float32, 0.003, nan},
        Case{MapLayer::relief, GDT_Float32, -0.478, nan}, Case{MapLayer::views, GDT_UInt16, 439, 0}}) {
    SCOPED_TRACE(static_cast<int>(expected.layer));
    const auto dataset = written(expected.layer, {0.02, 500000, 5400000, 100, "EPSG:32632"});
    ASSERT_NE(dataset, nullptr);
    ASSERT_EQ(dataset->GetRasterCount(), 1);
    EXPECT_EQ(dataset->GetRasterBand(1)->GetRasterDataType(), expected.type);
    const auto pixel = [&](int u, int v) {
      double value = -1;
      EXPECT_EQ(dataset->GetRasterBand(1)->RasterIO(GF_Read, u, v, 1, 1, &value, 1, 1, GDT_Float64, 0, 0, nullptr),
                CE_None);
      return value;
    };
    EXPECT_NEAR(pixel(700, 300), expected.value, 1e-5);
    if (std::isnan(expected.empty)) {
      EXPECT_TRUE(std::isnan(pixel(20, 300)));
    } else {
      EXPECT_EQ(pixel(20, 300), expected.empty);
    }
  }
}

template <class Value>
Value value_at(const std::string& bytes, std::size_t at) {
  Value value;
  std::memcpy(&value, bytes.data() + at, sizeof value);  // little-endian, as this machine
  return value;
}

TEST_F(GeoTiffTest, PointsHaveHeaderAndOneRecordPerCell) {
  const fs::path file = folder_ / "points.ply";
  write_map_points(file, bounds, {0.02, 500000, 5400000, 100, "EPSG:32632"}, read_cells);
  std::ifstream stream(file, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  constexpr std::size_t record = 3 * 8 + 4 + 3, points = 1000 * 700;
  const std::string end = "end_header\n";
  const std::size_t header = bytes.find(end) + end.size();
  ASSERT_EQ(bytes.size(), header + points * record);
  EXPECT_NE(bytes.find("\nelement vertex 700000\n"), std::string::npos);
  std::set<std::pair<int, int>> cells;
  for (const std::size_t at : {header, header + (points - 1) * record}) {
    const double x = value_at<double>(bytes, at) - 500000, y = value_at<double>(bytes, at + 8) - 5400000;
    const auto i = static_cast<int>(std::lround(x / 0.02 - 0.5)), j = static_cast<int>(std::lround(y / 0.02 - 0.5));
    cells.insert({i, j});
    EXPECT_TRUE(i >= -200 && i < 800 && j >= 40 && j < 740) << i << ", " << j;
    EXPECT_NEAR(x, (i + 0.5) * 0.02, 1e-6);
    EXPECT_NEAR(y, (j + 0.5) * 0.02, 1e-6);
    EXPECT_NEAR(value_at<double>(bytes, at + 16), 100 + height_at(i, j), 1e-6);  // heights are floats
    EXPECT_EQ(value_at<float>(bytes, at + 24), 0.003F);
    EXPECT_EQ(value_at<std::uint8_t>(bytes, at + 28), 200);
    EXPECT_EQ(value_at<std::uint8_t>(bytes, at + 29), 100);
    EXPECT_EQ(value_at<std::uint8_t>(bytes, at + 30), 50);
  }
  EXPECT_EQ(cells.size(), 2U);
}

// The map has six blocks, each of more bytes than a stream keeps; PLY counts the points first.
TEST_F(GeoTiffTest, PointsEndAtFirstFailedWrite) {
  int blocks = 0;
  const ReadMap counted = [&](const MapBox& box) {
    ++blocks;
    return read_cells(box);
  };
  const auto complaint = [&](auto* write_points) {
    blocks = 0;
    try {
      write_points("/dev/full", bounds, {0.02, 500000, 5400000, 100, "EPSG:32632"}, counted);
    } catch (const SystemError& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  EXPECT_EQ(complaint(write_map_points), "/dev/full: cannot be written: No space left on device");
  EXPECT_EQ(blocks, 6 + 1);
  EXPECT_EQ(complaint(write_map_las), "/dev/full: cannot be written: No space left on device");
  EXPECT_EQ(blocks, 1);
}

// Offsets are those of the tables of "LAS Specification 1.4 - R15" (ASPRS): public header block, variable length record
// header, point data record format 7.
TEST_F(GeoTiffTest, LasHasHeaderCoordinateSystemAndPoints) {
  const fs::path file = folder_ / "points.las";
  const MapReference reference{0.02, 500000, 5400000, 100, "EPSG:32632"};
  write_map_las(file, bounds, reference, read_cells);
  std::ifstream stream(file, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  constexpr std::uint64_t points = 1000 * 700;
  ASSERT_GT(bytes.size(), 375U);
  EXPECT_EQ(bytes.substr(0, 4), "LASF");
  EXPECT_EQ(value_at<std::uint16_t>(bytes, 6), 16);  // WKT
  EXPECT_EQ(bytes[24], 1);
  EXPECT_EQ(bytes[25], 4);
  EXPECT_EQ(value_at<std::uint16_t>(bytes, 94), 375);
  const auto data = value_at<std::uint32_t>(bytes, 96);
  ASSERT_EQ(value_at<std::uint32_t>(bytes, 100), 2U);
  EXPECT_EQ(bytes[104], 7);
  const std::size_t record = value_at<std::uint16_t>(bytes, 105);
  ASSERT_EQ(record, 40U);
  EXPECT_EQ(value_at<std::uint32_t>(bytes, 107), 0U);
  EXPECT_EQ(value_at<std::uint64_t>(bytes, 247), points);
  EXPECT_EQ(value_at<std::uint64_t>(bytes, 255), points);
  ASSERT_EQ(bytes.size(), data + points * record);
  // Cells −200 … 799 and 40 … 739 of 0.02 m, heights 0.001 i − 0.002 j above 100 m.
  const std::array<double, 6> limits{500000 + 799.5 * 0.02, 500000 - 199.5 * 0.02, 5400000 + 739.5 * 0.02,
                                     5400000 + 40.5 * 0.02, 100 + 0.799 - 0.08,    100 - 0.2 - 1.478};
  for (std::size_t k = 0; k < 6; ++k) EXPECT_NEAR(value_at<double>(bytes, 179 + 8 * k), limits[k], 6e-5) << k;

  EXPECT_EQ(bytes.substr(375 + 2, 16), std::string("LASF_Projection\0", 16));
  EXPECT_EQ(value_at<std::uint16_t>(bytes, 375 + 18), 2112);
  const std::size_t size = value_at<std::uint16_t>(bytes, 375 + 20);
  EXPECT_EQ(bytes[375 + 54 + size - 1], 0);
  OGRSpatialReference crs;
  ASSERT_EQ(crs.importFromWkt(bytes.c_str() + 375 + 54), OGRERR_NONE);
  EXPECT_EQ(crs.GetUTMZone(), 32);
  const std::size_t extra = 375 + 54 + size;
  EXPECT_EQ(value_at<std::uint16_t>(bytes, extra + 18), 4);
  EXPECT_EQ(value_at<std::uint16_t>(bytes, extra + 20), 192);
  EXPECT_EQ(bytes[extra + 54 + 2], 9);  // float
  EXPECT_EQ(bytes.substr(extra + 54 + 4, 6), std::string("sigma\0", 6));
  ASSERT_EQ(data, extra + 54 + 192);

  double worst_m = 0;
  std::set<std::pair<int, int>> cells;
  for (std::uint64_t n = 0; n < points; n += 1001) {
    const std::size_t at = data + n * record;
    std::array<double, 3> xyz{};
    for (std::size_t k = 0; k < 3; ++k) {
      xyz[k] = value_at<std::int32_t>(bytes, at + 4 * k) * value_at<double>(bytes, 131 + 8 * k) +
               value_at<double>(bytes, 155 + 8 * k);
    }
    const auto i = static_cast<int>(std::lround((xyz[0] - 500000) / 0.02 - 0.5));
    const auto j = static_cast<int>(std::lround((xyz[1] - 5400000) / 0.02 - 0.5));
    cells.insert({i, j});
    worst_m =
        std::max({worst_m, std::abs(xyz[0] - 500000 - (i + 0.5) * 0.02), std::abs(xyz[2] - 100 - height_at(i, j))});
    EXPECT_EQ(bytes[at + 14], 0x11);
    EXPECT_EQ(bytes[at + 16], 11);
    EXPECT_EQ(value_at<std::uint16_t>(bytes, at + 30), 200 * 257);
    EXPECT_EQ(value_at<std::uint16_t>(bytes, at + 32), 100 * 257);
    EXPECT_EQ(value_at<std::uint16_t>(bytes, at + 34), 50 * 257);
    EXPECT_EQ(value_at<float>(bytes, at + 36), 0.003F);
  }
  EXPECT_EQ(cells.size(), 700U);
  EXPECT_LT(worst_m, 6e-5);  // half a step, and float heights
  EXPECT_THROW(write_map_las(file, bounds, {0.02, 0, 0, 0, "EPSG:nonsense"}, read_cells), Error);
  EXPECT_THROW(write_map_las(folder_ / "none" / "p.las", bounds, reference, read_cells), SystemError);
}

}  // namespace
}  // namespace roadstereo::io
