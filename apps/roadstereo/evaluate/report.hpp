#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "roadstereo/image.hpp"

namespace CLI {
class App;
}

namespace roadstereo::cli {

/// Where an experiment leaves its figures besides the terminal; empty leaves a file out.
struct ReportFiles {
  std::string json;
  std::string figure;
};

/// Adds --json and --figure.
void add_report_options(CLI::App& command, ReportFiles& files);

/// Writes the document as JSON. Throws Error when the file cannot be opened, SystemError when the disk is full.
void write_report(const std::string& path, const nlohmann::ordered_json& document);

/// Writes a picture as PNG. Throws likewise.
void write_figure(const std::string& path, const Frame& picture);

}  // namespace roadstereo::cli
