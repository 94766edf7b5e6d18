#pragma once

#include <string_view>

/// Templates of the reports, embedded from this folder at build time.
namespace roadstereo::io::templates {

extern const std::string_view report;    ///< report.html: the document
extern const std::string_view style;     ///< report.css
extern const std::string_view sorting;   ///< sorting.js: sortable tables
extern const std::string_view relief3d;  ///< relief3d.js: the 3-D views
extern const std::string_view figure;    ///< figure.html: a titled image
extern const std::string_view table;     ///< table.html: the list of damages
extern const std::string_view legend;    ///< legend.html: legend of the severities
extern const std::string_view damage;    ///< damage.html: the section of one damage
extern const std::string_view relief;    ///< relief.html: the 3-D view in it
extern const std::string_view crop;      ///< crop.svg: image crop with the outline
extern const std::string_view depth;     ///< depth.svg: depth crop with the outline, holes hatched
extern const std::string_view profile;   ///< profile.svg: a cross-section
extern const std::string_view curve;     ///< curve.svg: values over time

}  // namespace roadstereo::io::templates
