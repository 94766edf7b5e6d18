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

void add_json_option(CLI::App& command, std::string& path) {
  command.add_option("--json", path, "Also write the results to this file")->type_name("FILE");
}

void add_figure_option(CLI::App& command, std::string& path) {
  command.add_option("--figure", path, "Also draw the maps: a PNG for people")->type_name("FILE");
}

void write_text(const std::string& path, const std::string& text) {
  write_bytes(path, text.data(), text.size());
}

void write_report(const std::string& path, const nlohmann::ordered_json& document) {
  write_text(path, json_text(document));
}

void write_figure(const std::string& path, const Frame& picture) {
  const auto bytes = io::encode_png(picture.view());
  write_bytes(path, reinterpret_cast<const char*>(bytes.data()), bytes.size());
}

}  // namespace roadstereo::cli
