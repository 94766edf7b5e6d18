// What all commands share: help, version, wrong usage.

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
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

TEST_F(CommandLine, InspectHelpFitsOnePage) {
  const Outcome help = run("inspect --help");
  EXPECT_EQ(help.out.rfind("Compute disparity", 0), 0U);
  EXPECT_LE(std::count(help.out.begin(), help.out.end(), '\n'), 67);
  EXPECT_NE(help.out.find("roadstereo options"), std::string::npos);
}

TEST_F(CommandLine, OptionsListsEveryKeyWithValueMeaningAndRange) {
  const Outcome all = run("options");
  EXPECT_EQ(all.exit_code, 0);
  const auto list = nlohmann::json::parse(run("options --json --preset paper").out);
  const auto options = list_options(preset("paper"));
  ASSERT_EQ(list.size(), options.size());
  for (std::size_t i = 0; i < options.size(); ++i) {
    EXPECT_NE(all.out.find(options[i].key + " "), std::string::npos) << options[i].key;
    EXPECT_EQ(list[i]["key"], options[i].key);
    EXPECT_EQ(list[i]["value"], options[i].value);
    EXPECT_EQ(list[i]["description"], options[i].description);
    if (options[i].key != "engine") {
      EXPECT_NE(list[i]["range"], "") << options[i].key;
    }
  }
}

TEST_F(CommandLine, OptionsOfOneGroupHaveTheirRanges) {
  const Outcome matcher = run("options matcher");
  EXPECT_EQ(matcher.exit_code, 0);
  EXPECT_EQ(matcher.out.find("roll."), std::string::npos);
  for (const char* part : {"pixels; between 1 and 10\n", "window; square or disc\n", "whole pixels; true or false\n",
                           "winner; parabola or gaussian\n"}) {
    EXPECT_NE(matcher.out.find(part), std::string::npos) << part;
  }
  EXPECT_NE(run("options coarse_search").out.find("; 2, 4 or 8, or 0 to derive it\n"), std::string::npos);
  const std::string one = run("options matcher.block_radius").out;
  EXPECT_TRUE(one.starts_with("matcher.block_radius ")) << one;
  EXPECT_EQ(std::count(one.begin(), one.end(), '\n'), 1);
  expect_complaint(run("options matching"), "matching");
  expect_complaint(run("options --preset best"), "best");
}

TEST_F(CommandLine, SuggestsNearestWord) {
  expect_complaint(run("inspekt left.png right.png --output result"),
                   "no command 'inspekt'; the nearest is 'inspect' (");
  expect_complaint(run("inspect left.png right.png --outptu result"),
                   "no option '--outptu'; the nearest is '--output' (");
  expect_complaint(run("synth --output road --sceen=demo"), "no option '--sceen'; the nearest is '--scene' (");
  expect_complaint(run("flatten"), "no command 'flatten' (");
  expect_complaint(run("--verison"), "no option '--verison'; the nearest is '--version' (");
}

TEST_F(CommandLine, PrintsVersion) {
  const Outcome outcome = run("--version");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.out.rfind("roadstereo ", 0), 0U);
}

TEST_F(CommandLine, HelpToFullDiskFails) {
  const int status = std::system("'" ROADSTEREO_BINARY "' --help > /dev/full 2> /dev/null");
  EXPECT_EQ(WEXITSTATUS(status), 1);
}

TEST_F(CommandLine, ControlCharactersDoNotReachTerminal) {
  const Outcome outcome = run("inspect \"$(printf 'l\\033[31mx.png')\" right.png --output result");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.err.find("l?[31mx.png"), std::string::npos) << outcome.err;
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

TEST_F(CommandLine, ShellCompletesCommandsAndOptions) {
  const Outcome script = run("completion bash");
  ASSERT_EQ(script.exit_code, 0) << script.err;
  write("completion.bash", script.out);
  const auto complete = [&](const std::string& words, int index) {
    const std::string command = "cd '" + folder_.string() + "' && bash -c 'source completion.bash; COMP_WORDS=(" +
                                words + "); COMP_CWORD=" + std::to_string(index) +
                                "; _roadstereo; echo \"${COMPREPLY[@]}\"' > reply.txt";
    EXPECT_EQ(std::system(command.c_str()), 0);
    return read_text(folder_ / "reply.txt");
  };
  EXPECT_EQ(complete("roadstereo insp", 1), "inspect\n");
  EXPECT_EQ(complete("roadstereo inspect --outp", 2), "--output\n");
  EXPECT_EQ(complete("roadstereo inspect flight --resu", 3), "--resume\n");
  EXPECT_EQ(complete("roadstereo --vers", 1), "--version\n");
  EXPECT_EQ(run("completion csh").exit_code, 2);
}

}  // namespace
}  // namespace roadstereo
