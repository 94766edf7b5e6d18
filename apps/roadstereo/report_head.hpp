#pragma once

#include <string>
#include <utility>
#include <vector>

namespace CLI {
class App;
}

namespace roadstereo::cli {

/// What the head of a report says of a survey.
struct ReportHead {
  std::string title;  ///< empty: the name of the source
  std::string road;
  std::string operator_name;
};

/// Adds --title, --road and --operator.
void add_head_options(CLI::App& command, ReportHead& head);

/// The title, or `source` if there is none.
std::string title_of(const ReportHead& head, const std::string& source);

/// Road and operator, as far as they are given, and the date of today.
std::vector<std::pair<std::string, std::string>> head_lines(const ReportHead& head);

}  // namespace roadstereo::cli
