#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "commands.hpp"
#include "roadstereo/matcher.hpp"

namespace roadstereo::cli {

namespace {

std::string engines_json() {
  auto list = nlohmann::ordered_json::array();
  for (const EngineInfo& engine : engines()) {
    list.push_back({{"name", engine.name}, {"description", engine.description}, {"exact", engine.exact}});
  }
  auto unavailable = nlohmann::ordered_json::array();
  for (const UnavailableEngine& engine : unavailable_engines()) {
    unavailable.push_back({{"name", engine.name}, {"reason", engine.reason}});
  }
  const nlohmann::ordered_json document = {
      {"auto", resolve_engine_name("auto")}, {"engines", list}, {"unavailable", unavailable}};
  return document.dump(2);
}

std::string engines_table() {
  std::string table;
  for (const EngineInfo& engine : engines()) {
    table += fmt::format("{:<12} {}{}\n", engine.name, engine.description, engine.exact ? " (exact)" : "");
  }
  for (const UnavailableEngine& engine : unavailable_engines()) {
    table += fmt::format("{:<12} unavailable: {}\n", engine.name, engine.reason);
  }
  return table + fmt::format("{:<12} {}\n", "auto", "selects " + resolve_engine_name("auto"));
}

}  // namespace

void add_engines(CLI::App& app) {
  CLI::App* command = app.add_subcommand("engines", "List the matching engines of this build, best first");
  command->footer("Example:\n  roadstereo engines");
  const auto as_json = std::make_shared<bool>(false);
  command->add_flag("--json", *as_json, "Print the list as JSON");
  command->callback([as_json] { fmt::print("{}", *as_json ? engines_json() + "\n" : engines_table()); });
}

}  // namespace roadstereo::cli
