#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <string>

#include "tests/cli/command_test.hpp"

namespace roadstereo {

/// A test beside `live --dds` in a process of its own, which publishes a rendered flight again and again, five pairs a
/// second: 320×180 pixels, f 175 px, 2.6 m above the road.
class LiveDdsTest : public CommandTest {
 protected:
  explicit LiveDdsTest(unsigned domain) : domain_(domain) {}

  void SetUp() override {
    CommandTest::SetUp();
    const Outcome made = run("synth --scene uav --size 320x180 --frames 4 --flight default --output flight --quiet");
    ASSERT_EQ(made.exit_code, 0) << made.err;
    publisher_ = ::fork();
    if (publisher_ != 0) return;
    if (::chdir(folder_.c_str()) != 0) ::_exit(127);
    const int nowhere = ::open("/dev/null", O_WRONLY);
    ::dup2(nowhere, STDOUT_FILENO);
    ::dup2(nowhere, STDERR_FILENO);
    ::execl(ROADSTEREO_BINARY, ROADSTEREO_BINARY, "live", "flight", "--calibration", "flight/calibration.yaml",
            "--rate", "5", "--loop", "--seconds", "60", "--dds", std::to_string(domain_).c_str(), nullptr);
    ::_exit(127);
  }
  void TearDown() override {
    if (publisher_ > 0) {
      ::kill(publisher_, SIGINT);
      int status = 0;
      ::waitpid(publisher_, &status, 0);
      EXPECT_TRUE(WIFEXITED(status));
    }
    CommandTest::TearDown();
  }

 private:
  unsigned domain_;
  pid_t publisher_ = -1;
};

}  // namespace roadstereo
