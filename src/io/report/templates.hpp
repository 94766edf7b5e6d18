#pragma once

#include <string_view>

/// The files of this folder that reports are put together from, embedded when the library is built.
namespace roadstereo::io::templates {

extern const std::string_view report;    ///< report.html: the document
extern const std::string_view style;     ///< report.css
extern const std::string_view sorting;   ///< sorting.js: the table's columns
extern const std::string_view relief3d;  ///< relief3d.js: the 3-D views
extern const std::string_view figure;    ///< figure.html: a titled picture
extern const std::string_view table;     ///< table.html: the list of damages
extern const std::string_view legend;    ///< legend.html: what the severities mean
extern const std::string_view damage;    ///< damage.html: the section of one damage
extern const std::string_view relief;    ///< relief.html: the 3-D view in it
extern const std::string_view crop;      ///< crop.svg: part of the image with the outline
extern const std::string_view depth;     ///< depth.svg: the same of the depths, with holes hatched
extern const std::string_view profile;   ///< profile.svg: a cross-section

}  // namespace roadstereo::io::templates
