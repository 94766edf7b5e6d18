#include <cpl_vsi.h>
#include <ogrsf_frmts.h>

#include <memory>
#include <mutex>
#include <sstream>

#include "io/geo/gdal_errors.hpp"
#include "io/geo/geo_columns.hpp"
#include "io/geo/layer_style.hpp"
#include "io/geo/track_segments.hpp"

namespace roadstereo::io {
namespace {

GDALDriver* geopackage_driver() {
  static std::once_flag once;
  std::call_once(once, RegisterOGRGeoPackage);  // only this one: the others load plugins
  return GetGDALDriverManager()->GetDriverByName("GPKG");
}

/// A file in GDAL's in-memory file system.
class MemoryFile {
 public:
  MemoryFile() {
    std::ostringstream name;
    name << "/vsimem/roadstereo-" << this << ".gpkg";  // unique
    name_ = name.str();
  }
  ~MemoryFile() { VSIUnlink(name_.c_str()); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  const char* name() const { return name_.c_str(); }
  std::vector<std::uint8_t> bytes() const {
    vsi_l_offset size = 0;
    const GByte* data = VSIGetMemFileBuffer(name(), &size, FALSE);
    if (data == nullptr) return {};
    return {data, data + size};
  }

 private:
  std::string name_;
};

struct FieldType {
  OGRFieldType type;
  OGRFieldSubType part = OFSTNone;
};

FieldType field_type(GeoType type) {
  switch (type) {
    case GeoType::whole:
      return {OFTInteger64};
    case GeoType::number:
      return {OFTReal};
    case GeoType::flag:
      return {OFTInteger, OFSTBoolean};
    case GeoType::time:
      return {OFTDateTime};
    case GeoType::text:
      break;
  }
  return {OFTString};
}

/// Sets one field of a feature.
struct SetField {
  OGRFeature& feature;
  int field;

  void operator()(std::monostate) const { feature.SetFieldNull(field); }
  void operator()(std::int64_t value) const { feature.SetField(field, GIntBig{value}); }
  void operator()(double value) const { feature.SetField(field, value); }
  void operator()(bool value) const { feature.SetField(field, value ? 1 : 0); }
  void operator()(const std::string& value) const { feature.SetField(field, value.c_str()); }
  void operator()(const UtcTime& time) const {
    constexpr int utc = 100;  // time zone flag of GDAL
    feature.SetField(field, time.year, time.month, time.day, time.hour, time.minute,
                     static_cast<float>(time.millisecond) / 1000, utc);
  }
};

std::unique_ptr<OGRGeometry> shape_of(const TrackSegment& segment) {
  auto line = std::make_unique<OGRLineString>();
  for (const TrackPoint& point : segment.points) line->addPoint(point.lon_deg, point.lat_deg);
  return line;
}

/// Returns null for an empty shape.
std::unique_ptr<OGRGeometry> geometry_of(const GeoShape& shape, bool polygon) {
  if (shape.empty()) return nullptr;
  if (!polygon) return std::make_unique<OGRPoint>(shape.front()[0], shape.front()[1]);
  auto ring = std::make_unique<OGRLinearRing>();
  for (const auto& corner : shape) ring->addPoint(corner[0], corner[1]);
  ring->closeRings();
  auto area = std::make_unique<OGRPolygon>();
  area->addRingDirectly(ring.release());
  return area;
}

/// Writes a GeoPackage.
class Package {
 public:
  explicit Package(const GdalErrors& errors) : errors_(errors) {
    GDALDriver* driver = geopackage_driver();
    errors_.require(driver != nullptr, "loading the driver GPKG");
    dataset_.reset(driver->Create(file_.name(), 0, 0, 0, GDT_Unknown, nullptr));
    errors_.require(dataset_ != nullptr, "creating the file");
    errors_.require(wgs84_.importFromEPSG(4326) == OGRERR_NONE, "looking up EPSG:4326");
    wgs84_.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    errors_.require(dataset_->StartTransaction() == OGRERR_NONE, "starting the transaction");
  }

  template <class Row>
  void add(const GeoLayer<Row>& layer, std::span<const Row> rows) {
    OGRLayer& made = create(layer.name, layer.polygons ? wkbPolygon : wkbPoint, layer.columns);
    for (const Row& row : rows) add_row(made, layer.columns, row, geometry_of(layer.shape(row), layer.polygons));
  }

  void add_track(const Track& track) {
    OGRLayer& made = create("track", wkbLineString, track_segment_columns());
    for (const TrackSegment& segment : track_segments(track)) {
      add_row(made, track_segment_columns(), segment, shape_of(segment));
    }
  }

  /// Adds QGIS styles, which its reader finds by the name of the table.
  void add_styles(std::span<const LayerStyle> styles) {
    const char* const options[] = {"FID=id", nullptr};
    OGRLayer& made = create("layer_styles", wkbNone, layer_style_columns(), const_cast<char**>(options));
    for (const LayerStyle& style : styles) add_row(made, layer_style_columns(), style, nullptr);
  }

  std::vector<std::uint8_t> finish() {
    errors_.require(dataset_->CommitTransaction() == OGRERR_NONE, "committing the transaction");
    dataset_.reset();  // the last bytes are written here
    std::vector<std::uint8_t> bytes = file_.bytes();
    errors_.require(!bytes.empty(), "writing");
    return bytes;
  }

 private:
  template <class Row>
  OGRLayer& create(const char* name, OGRwkbGeometryType shape, const std::vector<GeoColumn<Row>>& columns,
                   char** options = nullptr) {
    OGRLayer* layer = dataset_->CreateLayer(name, shape == wkbNone ? nullptr : &wgs84_, shape, options);
    errors_.require(layer != nullptr, "creating a layer");
    for (const GeoColumn<Row>& column : columns) {
      const FieldType type = field_type(column.type);
      OGRFieldDefn field(column.name.c_str(), type.type);
      field.SetSubType(type.part);
      errors_.require(layer->CreateField(&field) == OGRERR_NONE, "creating a column");
    }
    return *layer;
  }

  template <class Row>
  void add_row(OGRLayer& layer, const std::vector<GeoColumn<Row>>& columns, const Row& row,
               std::unique_ptr<OGRGeometry> shape) {
    const OGRFeatureUniquePtr feature(OGRFeature::CreateFeature(layer.GetLayerDefn()));
    errors_.require(feature != nullptr, "creating a feature");
    int field = 0;
    for (const GeoColumn<Row>& column : columns) std::visit(SetField{*feature, field++}, column.value(row));
    if (shape != nullptr) feature->SetGeometryDirectly(shape.release());
    errors_.require(layer.CreateFeature(feature.get()) == OGRERR_NONE, "writing a feature");
  }

  const GdalErrors& errors_;
  MemoryFile file_;  // outlives the dataset
  GDALDatasetUniquePtr dataset_;
  OGRSpatialReference wgs84_;
};

}  // namespace

std::vector<std::uint8_t> geopackage(const GeoLayers& layers, const Track& track) {
  const GdalErrors errors;
  Package package(errors);
  const std::vector<RoadDamage> damages = damage_rows(layers, false), candidates = damage_rows(layers, true);
  std::vector<LayerStyle> styles{severity_style("damages")};
  package.add(damage_layer(false), std::span<const RoadDamage>(damages));
  if (layers.with_candidates) {
    package.add(damage_layer(true), std::span<const RoadDamage>(candidates));
    styles.push_back(severity_style("candidates"));
  }
  package.add(sighting_layer(), layers.sightings);
  package.add(frame_layer(), layers.frames);
  package.add(footprint_layer(), layers.frames);
  package.add_track(track);
  package.add_styles(styles);
  return package.finish();
}

}  // namespace roadstereo::io
