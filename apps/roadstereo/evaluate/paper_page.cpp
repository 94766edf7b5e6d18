#include "evaluate/paper_page.hpp"

#include <fmt/core.h>

namespace roadstereo::cli {
namespace {

std::string escaped(const std::string& text) {
  std::string result;
  for (const char letter : text) {
    if (letter == '&') {
      result += "&amp;";
    } else if (letter == '<') {
      result += "&lt;";
    } else if (letter == '>') {
      result += "&gt;";
    } else {
      result += letter;
    }
  }
  return result;
}

/// A row of cells, each between `open` and `close`.
template <class Row, class Text>
std::string line(const Row& row, const char* open, const char* close, const Text& text_of) {
  std::string text;
  for (const auto& cell : row) text += open + text_of(cell) + close;
  return text;
}

std::string heading_of(const Column& column) {
  return column.heading;
}

std::string text_of(const Cell& cell) {
  return cell.text();
}

constexpr const char* style =
    "body{font:16px/1.45 sans-serif;max-width:70em;margin:2em auto;padding:0 "
    "1em}table{border-collapse:collapse;margin:1em "
    "0}td,th{border:1px solid #999;padding:.2em .6em;text-align:left}img{max-width:100%}code{background:#eee}";

}  // namespace

std::string markdown(const PaperPage& page) {
  std::string text = fmt::format("# {}\n\n{}\n", page.title, page.introduction);
  for (const PaperPart& part : page.parts) {
    text += fmt::format("\n## {}\n\n", part.title);
    if (!part.command.empty()) text += fmt::format("`{}`\n\n", part.command);
    if (!part.table.columns.empty()) {
      text += "|" + line(part.table.columns, " ", " |", heading_of) + "\n|";
      for (std::size_t i = 0; i < part.table.columns.size(); ++i) text += " --- |";
      text += "\n";
      for (const auto& row : part.table.rows) text += "|" + line(row, " ", " |", text_of) + "\n";
      text += "\n";
    }
    if (!part.figure.empty()) text += fmt::format("![{}]({})\n\n", part.title, part.figure);
    text += part.why + "\n";
  }
  return text;
}

std::string html(const PaperPage& page) {
  std::string text = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{}</title><style>{}</style></head>"
      "<body>\n<h1>{}</h1>\n<p>{}</p>\n",
      escaped(page.title), style, escaped(page.title), escaped(page.introduction));
  for (const PaperPart& part : page.parts) {
    text += fmt::format("<h2>{}</h2>\n", escaped(part.title));
    if (!part.command.empty()) text += fmt::format("<p><code>{}</code></p>\n", escaped(part.command));
    if (!part.table.columns.empty()) {
      text += "<table>\n<tr>" +
              line(part.table.columns, "<th>", "</th>", [](const Column& column) { return escaped(column.heading); }) +
              "</tr>\n";
      for (const auto& row : part.table.rows) {
        text += "<tr>" + line(row, "<td>", "</td>", [](const Cell& cell) { return escaped(cell.text()); }) + "</tr>\n";
      }
      text += "</table>\n";
    }
    if (!part.figure.empty()) {
      text += fmt::format("<p><img src=\"{}\" alt=\"{}\"></p>\n", escaped(part.figure), escaped(part.title));
    }
    text += fmt::format("<p>{}</p>\n", escaped(part.why));
  }
  return text + "</body></html>\n";
}

nlohmann::ordered_json json(const PaperPage& page) {
  nlohmann::ordered_json parts = nlohmann::ordered_json::array();
  for (const PaperPart& part : page.parts) {
    nlohmann::ordered_json one{{"title", part.title}};
    if (!part.command.empty()) one["command"] = part.command;
    if (!part.table.columns.empty()) one["rows"] = part.table.json();
    if (!part.figure.empty()) one["figure"] = part.figure;
    one["why"] = part.why;
    parts.push_back(one);
  }
  return {{"title", page.title}, {"introduction", page.introduction}, {"parts", parts}};
}

}  // namespace roadstereo::cli
