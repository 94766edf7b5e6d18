// A build without GStreamer: its pipelines are refused with what is missing.

#include <gtest/gtest.h>

#include <string>

#include "roadstereo/error.hpp"
#include "roadstereo/io/frame_source.hpp"

namespace {

TEST(WithoutGStreamer, ErrorNamesPackage) {
  try {
    roadstereo::io::open_source({"videotestsrc ! videoconvert"}, {});
    FAIL();
  } catch (const roadstereo::Error& error) {
    EXPECT_NE(std::string(error.what()).find("libgstreamer-plugins-base1.0-dev"), std::string::npos) << error.what();
  }
}

}  // namespace
