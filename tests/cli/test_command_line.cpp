// What all commands share: help, version, wrong usage.

#include <gtest/gtest.h>

#include <string>

#include "roadstereo/options.hpp"
#include "tests/cli/road_command_test.hpp"

namespace roadstereo {
namespace {

using CommandLine = RoadCommandTest;

TEST_F(CommandLine, HelpHasExamples) {
  const Outcome whole = run("--help");
  EXPECT_EQ(whole.exit_code, 0);
  for (const char* part : {"inspect", "synth", "engines", "Example"}) {
    EXPECT_NE(whole.out.find(part), std::string::npos) << part;
  }
  for (const std::string command : {"inspect", "synth", "engines"}) {
    const Outcome help = run(command + " --help");
    EXPECT_EQ(help.exit_code, 0);
    EXPECT_NE(help.out.find("roadstereo " + command), std::string::npos) << "an example of " << command;
  }
}

TEST_F(CommandLine, InspectHelpNamesEveryOption) {
  const Outcome help = run("inspect --help");
  for (const auto& option : list_options(preset("default"))) {
    EXPECT_NE(help.out.find(option.key), std::string::npos) << option.key;
  }
}

TEST_F(CommandLine, PrintsVersion) {
  const Outcome outcome = run("--version");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.out.rfind("roadstereo ", 0), 0U);
}

TEST_F(CommandLine, WrongUsageExitsWithTwo) {
  expect_complaint(run(""), 2, "subcommand");
  expect_complaint(run("flatten"), 2, "flatten");
  expect_complaint(run("inspect left.png --output result"), 2, "left.png: no such file");
  expect_complaint(run("inspect left.png right.png"), 2, "--output");
  expect_complaint(run("inspect left.png right.png --output result --colour red"), 2, "--colour");
  expect_complaint(run("inspect left.png right.png more.png --output result"), 2, "more.png");
  expect_complaint(run("inspect left.png right.png --output result --threads many"), 2, "--threads");
}

TEST_F(CommandLine, ListsEngines) {
  const Outcome table = run("engines");
  EXPECT_EQ(table.exit_code, 0);
  const auto list = nlohmann::json::parse(run("engines --json").out);
  ASSERT_FALSE(list["engines"].empty());
  EXPECT_EQ(list["auto"], list["engines"][0]["name"]);
  for (const auto& engine : list["engines"]) {
    EXPECT_NE(table.out.find(engine["name"].get<std::string>()), std::string::npos);
  }
}

}  // namespace
}  // namespace roadstereo
