#include "evaluate/report.hpp"

#include <CLI/CLI.hpp>
#include <fstream>

#include "json_text.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/io/image_file.hpp"

namespace roadstereo::cli {
namespace {

void write_bytes(const std::string& path, const char* bytes, std::size_t size) {
  std::ofstream file(path, std::ios::binary);
  if (!file) fail("cannot write ", path);
  file.write(bytes, static_cast<std::streamsize>(size));
  file.close();
  if (!file) throw SystemError("cannot write " + path + ": the disk may be full");
}

}  // namespace

void add_report_options(CLI::App& command, ReportFiles& files) {
  command.add_option("--json", files.json, "Also write the results to this file")->type_name("FILE");
  command.add_option("--figure", files.figure, "Also draw them: a PNG for people")->type_name("FILE");
}

void write_report(const std::string& path, const nlohmann::ordered_json& document) {
  const std::string text = json_text(document);
  write_bytes(path, text.data(), text.size());
}

void write_figure(const std::string& path, const Frame& picture) {
  const auto bytes = io::encode_png(picture.view());
  write_bytes(path, reinterpret_cast<const char*>(bytes.data()), bytes.size());
}

}  // namespace roadstereo::cli
