#pragma once

#include <string_view>

/// The files of this folder, embedded when the program is built. {{query}} stands for the token of every address.
namespace roadstereo::cli::page_files {

extern const std::string_view page;    ///< page.html
extern const std::string_view style;   ///< page.css
extern const std::string_view script;  ///< page.js

}  // namespace roadstereo::cli::page_files
