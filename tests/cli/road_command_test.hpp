#pragma once

#include <filesystem>
#include <fstream>
#include <set>
#include <string>

#include "tests/cli/command_test.hpp"

namespace roadstereo {

inline void write_text(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

inline std::set<std::string> names_in(const std::filesystem::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) names.insert(entry.path().filename().string());
  return names;
}

/// A test that runs commands on a small synthetic road.
class RoadCommandTest : public CommandTest {
 protected:
  /// A small pair with calibration and truth in the folder "road".
  void make_road() const {
    const Outcome outcome = run("synth --scene demo --size 320x180 --output road --quiet");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  }

  Outcome inspect(const std::string& arguments = "--calibration road/calibration.yaml") const {
    return run("inspect road/left.png road/right.png --output result " + arguments);
  }
};

}  // namespace roadstereo
