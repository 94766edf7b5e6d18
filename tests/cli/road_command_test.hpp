#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include "tests/cli/command_test.hpp"

namespace roadstereo {

inline void write_text(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
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
