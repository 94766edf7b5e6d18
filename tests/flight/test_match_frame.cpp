// What of a pair goes into the record of its frame.
#include <gtest/gtest.h>

#include "flight/match_frame.hpp"

namespace roadstereo::cli {
namespace {

// File names are bytes; the record is the same before and after the journal, which is UTF-8.
TEST(MatchFrame, RecordsNamesAsUtf8) {
  FlightJob job;
  job.pair.name =
      "fl\xfc"
      "g";
  job.pair.error =
      "left/fl\xfc"
      "g.png has no right image";
  record_rejected(std::nullopt, job);
  EXPECT_EQ(job.frame.status, io::FrameStatus::rejected);
  EXPECT_EQ(job.frame.name, "fl\xef\xbf\xbdg");
  EXPECT_EQ(job.frame.reason, "left/fl\xef\xbf\xbdg.png has no right image");
}

}  // namespace
}  // namespace roadstereo::cli
