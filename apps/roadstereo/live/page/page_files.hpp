#pragma once

#include <string_view>

/// Files of this folder, embedded at build time. {{query}} is replaced by the query with the token.
namespace roadstereo::cli::page_files {

extern const std::string_view page;    ///< page.html
extern const std::string_view style;   ///< page.css
extern const std::string_view script;  ///< page.js

}  // namespace roadstereo::cli::page_files
