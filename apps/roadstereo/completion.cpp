#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "commands.hpp"

namespace roadstereo::cli {
namespace {

constexpr const char* before =
    R"(# Completes commands and options of roadstereo in bash, and in zsh after "autoload bashcompinit; bashcompinit".
_roadstereo() {
  local command=""
  if [ "$COMP_CWORD" -gt 1 ]; then command="${COMP_WORDS[1]}"; fi
  if [ "$command" = evaluate ] && [ "$COMP_CWORD" -gt 2 ]; then command="evaluate ${COMP_WORDS[2]}"; fi
  local words=""
  case "$command" in
)";
constexpr const char* after = R"(  esac
  COMPREPLY=($(compgen -W "$words" -- "${COMP_WORDS[COMP_CWORD]}"))
}
complete -o default -F _roadstereo roadstereo
)";

/// Adds a line with the commands and options of `app`, and those of its commands.
void add_words(const CLI::App& app, const std::string& path, std::string& text) {
  const auto all = [](const CLI::App*) { return true; };
  std::string words;
  for (const CLI::App* command : app.get_subcommands(all)) words += " " + command->get_name();
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) words += " --" + name;
  }
  text += fmt::format("    \"{}\") words=\"{}\" ;;\n", path, words.empty() ? words : words.substr(1));
  for (const CLI::App* command : app.get_subcommands(all)) {
    add_words(*command, path.empty() ? command->get_name() : path + " " + command->get_name(), text);
  }
}

}  // namespace

void add_completion(CLI::App& app) {
  CLI::App* command = app.add_subcommand("completion", "Print a script that completes commands and options in a shell");
  command->footer(
      "Example, for this shell and for every new one:\n"
      "  source <(roadstereo completion bash)\n"
      "  roadstereo completion bash > ~/.local/share/bash-completion/completions/roadstereo");
  const auto shell = std::make_shared<std::string>("bash");
  command->add_option("SHELL", *shell, "bash; zsh reads the same script with bashcompinit")
      ->check(CLI::IsMember({"bash", "zsh"}))
      ->capture_default_str();
  command->callback([&app, shell] {
    std::string text = before;
    add_words(app, "", text);
    fmt::print("{}{}", text, after);
  });
}

}  // namespace roadstereo::cli
