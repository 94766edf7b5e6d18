#include "report_head.hpp"

#include <fmt/chrono.h>

#include <CLI/CLI.hpp>
#include <ctime>

namespace roadstereo::cli {

void add_head_options(CLI::App& command, ReportHead& head) {
  command.add_option("--title", head.title, "Title of the report; default: the name of the source")->type_name("TEXT");
  command.add_option("--road", head.road, "Name of the road in the report")->type_name("TEXT");
  command.add_option("--operator", head.operator_name, "Name of the operator in the report")->type_name("TEXT");
}

std::string title_of(const ReportHead& head, const std::string& source) {
  return head.title.empty() ? source : head.title;
}

std::vector<std::pair<std::string, std::string>> head_lines(const ReportHead& head) {
  std::vector<std::pair<std::string, std::string>> lines;
  if (!head.road.empty()) lines.emplace_back("Road", head.road);
  if (!head.operator_name.empty()) lines.emplace_back("Operator", head.operator_name);
  lines.emplace_back("Report of", fmt::format("{:%Y-%m-%d}", fmt::localtime(std::time(nullptr))));
  return lines;
}

}  // namespace roadstereo::cli
