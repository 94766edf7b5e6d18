#include "roadstereo/options.hpp"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "commands.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::cli {
namespace {

struct OptionsArguments {
  std::string group;  ///< empty: all
  std::string preset = "default";
  bool json = false;
};

/// Returns the part of a message after `words`; empty if they are not in it.
std::string part_after(const std::string& message, const std::string& words) {
  const std::size_t at = message.find(words);
  return at == std::string::npos ? "" : message.substr(at + words.size());
}

/// Returns the values that an option takes, in the words of the errors for values that no option takes.
std::string range_of(const OptionText& option) {
  std::string words;
  for (const char* impossible : {"nan", "-2147483648"}) {
    try {
      PipelineOptions options = preset("default");
      set_option(options, option.key, impossible);
      options.validate();
    } catch (const Error& error) {
      std::string range = part_after(error.what(), "it must be ");
      if (!range.empty()) return range;
      words = part_after(error.what(), "it takes ");
    }
  }
  return words;
}

void print_options(const OptionsArguments& arguments) {
  auto list = nlohmann::ordered_json::array();
  for (const OptionText& option : list_options(preset(arguments.preset))) {
    if (!option.key.starts_with(arguments.group)) continue;
    const std::string range = range_of(option);
    list.push_back(
        {{"key", option.key}, {"value", option.value}, {"description", option.description}, {"range", range}});
    if (arguments.json) continue;
    fmt::print("{:<38} {:<12} {}{}{}\n", option.key, option.value, option.description, range.empty() ? "" : "; ",
               range);
  }
  if (list.empty()) fail("there is no option that starts with '", arguments.group, "'; see roadstereo options");
  if (arguments.json) fmt::print("{}\n", list.dump(2));
}

constexpr const char* options_footer =
    R"(Prints the key, the value in the preset, the meaning with its unit, and the values that are allowed.

Examples:
  roadstereo options matcher
  roadstereo options --preset paper
  roadstereo inspect left.png right.png --output out --set matcher.sigma_space=2 --set damage.min_depth_m=0.01)";

}  // namespace

void add_options(CLI::App& app) {
  CLI::App* command = app.add_subcommand("options", "List the keys of --set");
  command->footer(options_footer);
  const auto arguments = std::make_shared<OptionsArguments>();
  command->add_option("GROUP", arguments->group,
                      "Only the keys that start with GROUP. (road_model, matcher, damage, ...)");
  command->add_option("--preset", arguments->preset, "Preset whose values are printed")
      ->type_name("NAME")
      ->capture_default_str();
  command->add_flag("--json", arguments->json, "Print the list as JSON");
  command->callback([arguments] { print_options(*arguments); });
}

}  // namespace roadstereo::cli
