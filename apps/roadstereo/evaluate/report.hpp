#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "roadstereo/image.hpp"

namespace CLI {
class App;
}

namespace roadstereo::cli {

/// Add --json: the file of the results; empty: none.
void add_json_option(CLI::App& command, std::string& path);

/// Add --figure: the file of a picture; empty: none.
void add_figure_option(CLI::App& command, std::string& path);

/// Write a text. Throws Error if the file cannot be opened, SystemError if writing fails.
void write_text(const std::string& path, const std::string& text);

/// Write the document as JSON. Throws likewise.
void write_report(const std::string& path, const nlohmann::ordered_json& document);

/// Writes a picture as PNG. Throws likewise.
void write_figure(const std::string& path, const Frame& picture);

}  // namespace roadstereo::cli
