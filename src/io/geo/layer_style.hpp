#pragma once

#include <string>
#include <vector>

#include "io/geo/geo_columns.hpp"

namespace roadstereo::io {

/// One row of the table `layer_styles`, from which QGIS takes the default style of a layer.
struct LayerStyle {
  std::string layer;
  std::string qml;  ///< the style, XML of QGIS
};

/// Columns of `layer_styles` as QGIS names them.
const std::vector<GeoColumn<LayerStyle>>& layer_style_columns();

/// Style of a layer of polygons by the column `severity`, with the colours of the reports.
LayerStyle severity_style(const std::string& layer);

}  // namespace roadstereo::io
