// One page that compares the paper with this program, as Markdown, HTML and JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "evaluate/table.hpp"

namespace roadstereo::cli {

/// A table or a figure of the paper.
struct PaperPart {
  std::string title;
  std::string command;  ///< that prints our values; empty: none
  Table table;          ///< no columns: a figure only
  std::string figure;   ///< file beside the page; empty: none
  std::string why;      ///< the values differ, or there are none
};

struct PaperPage {
  std::string title, introduction;
  std::vector<PaperPart> parts;
};

std::string markdown(const PaperPage& page);
/// A document by itself but for the figures.
std::string html(const PaperPage& page);
nlohmann::ordered_json json(const PaperPage& page);

}  // namespace roadstereo::cli
