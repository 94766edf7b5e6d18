#include <gtest/gtest.h>

#include <set>
#include <string>

#include "roadstereo/io/flight_report.hpp"

namespace roadstereo::io {
namespace {

/// Numbers after each `before` in a text.
std::set<int> numbers_after(const std::string& text, const std::string& before) {
  std::set<int> numbers;
  for (std::size_t at = text.find(before); at != std::string::npos; at = text.find(before, at + 1)) {
    numbers.insert(std::stoi(text.substr(at + before.size(), 8)));
  }
  return numbers;
}

// The table has rows for the worst 200 only. Map, segments and cards name others, too.
TEST(FlightReport, LinksLeadSomewhere) {
  constexpr int count = 230;
  FlightReportInput input;
  input.inspected = 1;
  input.track_deg = {{9, 48.5}, {9.3, 48.5}};
  input.damages.resize(count);
  for (int i = 0; i < count; ++i) {
    RoadDamage& damage = input.damages[static_cast<std::size_t>(i)].damage;
    damage.id = count - i;
    damage.position = GeoPosition{48.5, 9 + 0.001 * i, 0, 0};
    damage.best.max_depth_px = {1.0 + i, 0.1};
    RoadSegment segment;
    segment.worst = damage.id;
    segment.damages = segment.inspected = 1;
    input.segments.push_back(segment);
  }
  const std::string html = flight_report(input);
  const std::set<int> links = numbers_after(html, "href=\"#damage-"), rows = numbers_after(html, "id=\"damage-");
  EXPECT_EQ(rows.size(), 200U);
  EXPECT_EQ(links, rows);
  EXPECT_NE(html.find(">damage 1<"), std::string::npos) << "the deepest has no row";
  EXPECT_NE(html.find("<title>1: "), std::string::npos) << "the map shows all";
}

}  // namespace
}  // namespace roadstereo::io
