#include "unknown_word.hpp"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <vector>

#include "core/edit_distance.hpp"

namespace roadstereo::cli {
namespace {

std::vector<std::string> command_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::App* inner : command.get_subcommands([](const CLI::App*) { return true; })) {
    names.push_back(inner->get_name());
  }
  return names;
}

std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

std::string message_about(const char* kind, const std::string& word, const std::vector<std::string>& known) {
  std::string message = fmt::format("there is no {} '{}'", kind, word);
  const auto nearest = std::min_element(known.begin(), known.end(), [&](const std::string& a, const std::string& b) {
    return edit_distance(word, a) < edit_distance(word, b);
  });
  const bool near =
      nearest != known.end() && edit_distance(word, *nearest) <= std::max<std::size_t>(1, word.size() / 3);
  return near ? fmt::format("{}; the nearest is '{}'", message, *nearest) : message;
}

}  // namespace

std::string unknown_word(const CLI::App& app) {
  const CLI::App* command = &app;
  while (!command->get_subcommands().empty()) command = command->get_subcommands().front();
  for (const std::string& word : app.remaining(true)) {
    if (word.rfind('-', 0) == 0) {
      return message_about("option", word.substr(0, word.find('=')), option_names(*command));
    }
    const std::vector<std::string> commands = command_names(*command);
    if (!commands.empty()) return message_about("command", word, commands);
  }
  return "";
}

}  // namespace roadstereo::cli
