#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "roadstereo/image.hpp"

namespace CLI {
class App;
}

namespace roadstereo::cli {

/// Output files of an experiment; empty: no file.
struct ReportFiles {
  std::string json;
  std::string figure;
};

/// Add --json and --figure.
void add_report_options(CLI::App& command, ReportFiles& files);

/// Write the document as JSON. Throws Error if the file cannot be opened, SystemError if writing fails.
void write_report(const std::string& path, const nlohmann::ordered_json& document);

/// Writes a picture as PNG. Throws likewise.
void write_figure(const std::string& path, const Frame& picture);

}  // namespace roadstereo::cli
