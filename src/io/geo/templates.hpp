#pragma once

#include <string_view>

/// Templates of the QGIS style, embedded from this folder at build time.
namespace roadstereo::io::geo_templates {

extern const std::string_view style;     ///< layer_style.qml
extern const std::string_view category;  ///< style_category.xml: one class
extern const std::string_view symbol;    ///< style_symbol.xml: its symbol

}  // namespace roadstereo::io::geo_templates
