// `live` from outside: what it rejects.

#include <gtest/gtest.h>

#include "tests/cli/road_command_test.hpp"

namespace roadstereo {
namespace {

using LiveCommand = RoadCommandTest;

TEST_F(LiveCommand, RejectsBadOptions) {
  expect_complaint(run("live missing.mp4"), "missing.mp4");
  expect_complaint(run("live missing.mp4 --serve nonsense"), "--serve is \"nonsense\"");
  expect_complaint(run("live missing.mp4 --set nonsense=1"), "nonsense");
  expect_complaint(run("live missing.mp4 --layout sideways"), "sideways");
}

}  // namespace
}  // namespace roadstereo
