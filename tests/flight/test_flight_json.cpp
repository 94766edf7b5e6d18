// The summary of a recording.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "flight/flight_json.hpp"

namespace roadstereo::cli {
namespace {

// Programs that read it need not know which damage there is.
TEST(FlightJson, CountsEverySeverity) {
  FlightRun run;
  run.calibration_format = "yaml";
  std::vector<io::RoadDamage> damages(1);
  damages[0].best.metrics.emplace().severity = Severity::high;
  const auto summary = nlohmann::ordered_json::parse(flight_json({}, run, {}, damages));
  const nlohmann::ordered_json expected{{"high", 1},      {"medium", 0},       {"low", 0},    {"minor", 0},
                                        {"uncertain", 0}, {"unresolvable", 0}, {"unknown", 0}};
  EXPECT_EQ(summary["damages"]["by_severity"], expected);
}

}  // namespace
}  // namespace roadstereo::cli
