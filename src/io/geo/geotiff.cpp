#include "roadstereo/io/geotiff.hpp"

#include <gdal_frmts.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <mutex>
#include <utility>
#include <vector>

#include "io/geo/gdal_errors.hpp"
#include "io/geo/map_crs.hpp"

namespace roadstereo::io {
namespace {

GDALDriver* driver(const char* name) {
  static std::once_flag once;
  std::call_once(once, [] {  // only these: the others load plugins
    GDALRegister_GTiff();
    GDALRegister_COG();
  });
  return GetGDALDriverManager()->GetDriverByName(name);
}

/// Bounds GDAL's block cache during its lifetime.
class BlockCacheLimit {
 public:
  BlockCacheLimit() : before_(GDALGetCacheMax64()) { GDALSetCacheMax64(max_bytes); }
  ~BlockCacheLimit() { GDALSetCacheMax64(before_); }
  BlockCacheLimit(const BlockCacheLimit&) = delete;
  BlockCacheLimit& operator=(const BlockCacheLimit&) = delete;

 private:
  static constexpr GIntBig max_bytes = GIntBig{64} << 20;
  GIntBig before_;
};

/// Removes a file at the end.
struct ScratchFile {
  std::string name;
  ~ScratchFile() { VSIUnlink(name.c_str()); }
};

/// Cells and poses are metres towards east and north.
void require_metres_east_north(const OGRSpatialReference& crs, const std::string& name) {
  const char* unit = "";
  if (const double metres = crs.GetLinearUnits(&unit); std::abs(metres - 1) > 1e-9) {
    fail("--crs ", name, ": the unit of this coordinate system is ", unit, ", ", metres, " m; it must be the metre");
  }
  for (const int axis : {0, 1}) {
    OGRAxisOrientation towards = OAO_Other;
    crs.GetAxis(nullptr, axis, &towards);
    if (towards == OAO_South || towards == OAO_West) {
      fail("--crs ", name, ": an axis of this coordinate system leads ", OSRAxisEnumToName(towards),
           "; they must lead east and north");
    }
  }
}

OGRSpatialReference spatial_reference(const MapReference& reference, const GdalErrors& errors) {
  OGRSpatialReference crs;
  if (reference.crs.empty()) {
    errors.require(crs.SetLocalCS("roadstereo map") == OGRERR_NONE, "naming the coordinate system");
    errors.require(crs.SetLinearUnits(SRS_UL_METER, 1) == OGRERR_NONE, "setting metres");
  } else if (crs.SetFromUserInput(reference.crs.c_str()) != OGRERR_NONE) {
    fail("--crs ", reference.crs, ": GDAL does not know this coordinate system");
  } else if (crs.IsGeographic() || crs.IsGeocentric()) {
    fail("--crs ", reference.crs, ": this coordinate system is not projected; cells and poses are in metres");
  } else {
    require_metres_east_north(crs, reference.crs);
  }
  crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return crs;
}

struct LayerFormat {
  int bands;
  GDALDataType type;
  std::vector<std::pair<const char*, const char*>> options;  ///< of the COG driver
};

LayerFormat format_of(MapLayer layer) {
  switch (layer) {
    case MapLayer::orthophoto:
      return {4, GDT_Byte, {{"COMPRESS", "JPEG"}, {"QUALITY", "90"}, {"OVERVIEW_RESAMPLING", "AVERAGE"}}};
    case MapLayer::views:
      return {1, GDT_UInt16, {{"COMPRESS", "DEFLATE"}, {"OVERVIEW_RESAMPLING", "NEAREST"}}};
    default:
      return {1, GDT_Float32, {{"COMPRESS", "DEFLATE"}, {"PREDICTOR", "YES"}, {"OVERVIEW_RESAMPLING", "AVERAGE"}}};
  }
}

/// Writes one block of a layer at column u and row v of the raster.
class BlockWriter {
 public:
  BlockWriter(GDALDataset& dataset, MapLayer layer, const MapReference& reference, const GdalErrors& errors)
      : dataset_(dataset), layer_(layer), reference_(reference), errors_(errors) {}

  void write(int u, int v, MapRaster& raster) {
    if (layer_ == MapLayer::orthophoto) return write_colours(u, v, raster);
    if (layer_ == MapLayer::views) return write_band(1, u, v, raster.views.row(0), raster.box, GDT_UInt16);
    Image<float>& values = layer_ == MapLayer::sigma ? raster.sigma : raster.height;
    if (layer_ == MapLayer::height && reference_.up_m != 0) {
      float* const heights = values.row(0);
      std::transform(heights, heights + values.pixels(), heights,
                     [&](float height) { return static_cast<float>(height + reference_.up_m); });
    }
    write_band(1, u, v, values.row(0), raster.box, GDT_Float32);
  }

 private:
  void write_colours(int u, int v, MapRaster& raster) {
    std::vector<std::uint8_t> band(raster.colour.pixels());
    const std::array<std::uint8_t, 3>* const colours = raster.colour.row(0);
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t i = 0; i < band.size(); ++i) band[i] = colours[i][k];
      write_band(static_cast<int>(k) + 1, u, v, band.data(), raster.box, GDT_Byte);
    }
    const std::uint16_t* const views = raster.views.row(0);
    for (std::size_t i = 0; i < band.size(); ++i) band[i] = views[i] > 0 ? 255 : 0;
    write_band(4, u, v, band.data(), raster.box, GDT_Byte);
  }

  void write_band(int band, int u, int v, void* values, const MapBox& box, GDALDataType type) {
    const CPLErr done = dataset_.GetRasterBand(band)->RasterIO(GF_Write, u, v, box.columns, box.rows, values,
                                                               box.columns, box.rows, type, 0, 0);
    errors_.require(done == CE_None, "writing a block");
  }

  GDALDataset& dataset_;
  MapLayer layer_;
  const MapReference& reference_;
  const GdalErrors& errors_;
};

GDALDatasetUniquePtr create_plain(const std::string& file, const MapBox& bounds, const LayerFormat& format,
                                  const MapReference& reference, const GdalErrors& errors) {
  CPLStringList options;
  options.SetNameValue("TILED", "YES");
  options.SetNameValue("BIGTIFF", "IF_SAFER");
  options.SetNameValue("SPARSE_OK", "TRUE");
  if (format.bands == 4) {
    options.SetNameValue("PHOTOMETRIC", "RGB");
    options.SetNameValue("ALPHA", "YES");
    options.SetNameValue("INTERLEAVE", "PIXEL");
  }
  GDALDatasetUniquePtr dataset(
      driver("GTiff")->Create(file.c_str(), bounds.columns, bounds.rows, format.bands, format.type, options.List()));
  errors.require(dataset != nullptr, "creating a scratch file");
  const OGRSpatialReference crs = spatial_reference(reference, errors);
  errors.require(dataset->SetSpatialRef(&crs) == CE_None, "setting the coordinate system");
  std::array<double, 6> transform{reference.east_m + bounds.i0 * reference.cell_m,
                                  reference.cell_m,
                                  0,
                                  reference.north_m + (bounds.j0 + bounds.rows) * reference.cell_m,
                                  0,
                                  -reference.cell_m};
  errors.require(dataset->SetGeoTransform(transform.data()) == CE_None, "setting the position");
  if (format.type == GDT_Float32) {
    errors.require(dataset->GetRasterBand(1)->SetNoDataValue(std::numeric_limits<double>::quiet_NaN()) == CE_None,
                   "setting the value without data");
  }
  return dataset;
}

}  // namespace

std::string map_wkt(const MapReference& reference) {
  const GdalErrors errors("the coordinate system");
  char* text = nullptr;
  const char* const options[] = {"FORMAT=WKT1_GDAL", nullptr};
  errors.require(spatial_reference(reference, errors).exportToWkt(&text, options) == OGRERR_NONE, "exporting");
  std::string wkt = text;
  CPLFree(text);
  return wkt;
}

void write_geotiff(const std::filesystem::path& file, MapLayer layer, const MapBox& bounds,
                   const MapReference& reference, const ReadMap& read) {
  constexpr int block = 512;
  if (bounds.empty()) fail("the map is empty");
  const GdalErrors errors(file.string());
  const BlockCacheLimit limit;
  const LayerFormat format = format_of(layer);
  errors.require(driver("GTiff") != nullptr && driver("COG") != nullptr, "loading the drivers GTiff and COG");
  const ScratchFile scratch{file.string() + ".blocks"};
  GDALDatasetUniquePtr plain = create_plain(scratch.name, bounds, format, reference, errors);
  BlockWriter writer(*plain, layer, reference, errors);
  for (int v = 0; v < bounds.rows; v += block) {
    for (int u = 0; u < bounds.columns; u += block) {
      const int columns = std::min(block, bounds.columns - u), rows = std::min(block, bounds.rows - v);
      MapRaster raster = read({bounds.i0 + u, bounds.j0 + bounds.rows - v - rows, columns, rows});
      writer.write(u, v, raster);
    }
  }
  CPLStringList options;
  for (const auto& [name, value] : format.options) options.SetNameValue(name, value);
  options.SetNameValue("BIGTIFF", "IF_SAFER");
  GDALDatasetUniquePtr optimised(
      driver("COG")->CreateCopy(file.string().c_str(), plain.get(), TRUE, options.List(), nullptr, nullptr));
  errors.require(optimised != nullptr, "writing");
  optimised.reset();  // the last bytes are written here
  errors.require(true, "closing the file");
}

}  // namespace roadstereo::io
