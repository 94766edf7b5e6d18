// What a flight leaves behind: journal, tables, the inventory of its damages, the report.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "roadstereo/error.hpp"
#include "roadstereo/io/flight_inventory.hpp"
#include "roadstereo/io/flight_journal.hpp"
#include "roadstereo/io/flight_pictures.hpp"
#include "roadstereo/io/flight_report.hpp"
#include "roadstereo/io/flight_tables.hpp"

namespace roadstereo::io {
namespace {

namespace fs = std::filesystem;

/// A pothole with its box at that place.
Damage pothole(int u, int v, double depth_m = 0.05, double error_m = 0.001) {
  Damage damage;
  damage.id = 1;
  damage.pixels = 1600;
  damage.box_px = {u - 20, v - 20, u + 19, v + 19};
  damage.centroid_px = {u - 0.5, v - 0.5};
  damage.max_depth_px = {10 * depth_m, 0.1};
  damage.metrics.emplace();
  damage.metrics->max_depth_m = {depth_m, error_m};
  damage.metrics->severity = Severity::medium;
  return damage;
}

FlightFrame frame_of(std::int64_t index, std::vector<Damage> damages) {
  FlightFrame frame;
  frame.index = index;
  frame.name = std::to_string(index);
  frame.road_status = RoadStatus::tracked;
  frame.damages = std::move(damages);
  return frame;
}

std::string text_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

class FlightJournalFile : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    file_ = fs::temp_directory_path() / (std::string("roadstereo_journal_") + test->name() + std::to_string(getpid()));
  }
  void TearDown() override { fs::remove(file_); }
  fs::path file_;
};

TEST(FlightFrameJson, RoundTripIsExact) {
  FlightFrame frame = frame_of(7, {pothole(100, 50, 0.1 / 3), pothole(200, 50)});
  frame.damages[1].metrics.reset();
  frame.damages[1].kind = DamageKind::protrusion;
  frame.time_s = 1403636579.763555584;
  frame.roll_rad = -0.1 / 3;
  frame.road = {1.0 / 3, 2.0 / 7, -1e-17};
  frame.warnings = {"a \"quoted\" word", "line\nend"};
  frame.pipeline_state = {640, 360, TrackedRoad{{1.0 / 3, 1e-300, 5}, 0.1, 0.7}, 1.0 / 7, -0.3};
  const FlightFrame back = read_flight_frame(flight_frame_json(frame));
  EXPECT_EQ(back.index, 7);
  EXPECT_EQ(back.time_s, frame.time_s);
  EXPECT_EQ(back.roll_rad, frame.roll_rad);
  EXPECT_EQ(back.road.a0, frame.road.a0);
  EXPECT_EQ(back.road.a2, frame.road.a2);
  EXPECT_TRUE(std::isnan(back.height_m));
  EXPECT_EQ(back.warnings, frame.warnings);
  EXPECT_EQ(back.pipeline_state.road->model.a1, 1e-300);
  EXPECT_EQ(back.pipeline_state.road->inlier_share, 0.1);
  EXPECT_EQ(back.pipeline_state.road->correlation, 0.7);
  EXPECT_EQ(back.pipeline_state.row_offset_px, -0.3);
  ASSERT_EQ(back.damages.size(), 2U);
  EXPECT_EQ(back.damages[0].metrics->max_depth_m.value, 0.1 / 3);
  EXPECT_EQ(back.damages[0].metrics->severity, Severity::medium);
  EXPECT_FALSE(back.damages[1].metrics);
  EXPECT_EQ(back.damages[1].kind, DamageKind::protrusion);
  EXPECT_EQ(flight_frame_json(back), flight_frame_json(frame));
  EXPECT_EQ(flight_frame_json(frame).find('\n'), std::string::npos) << "a line is a frame";
}

TEST(FlightFrameJson, RejectsIntegersOutOfRange) {
  const std::string good = flight_frame_json(frame_of(7, {}));
  const auto with = [&good](const std::string& key, const std::string& value) {
    std::string json = good;
    const std::size_t at = json.find("\"" + key + "\":") + key.size() + 3;
    return json.replace(at, json.find(',', at) - at, value);
  };
  EXPECT_EQ(read_flight_frame(with("frame", "8")).index, 8);
  for (const char* wrong : {"4444444444444444444444444444444444444444444444440", "4.4e48", "1.5", "9223372036854775808",
                            "true", "\"8\"", "null"}) {
    EXPECT_THROW(read_flight_frame(with("frame", wrong)), Error) << wrong;
  }
  for (const char* wrong : {"2147483648", "-2147483649", "0.5"}) {
    EXPECT_THROW(read_flight_frame(with("status", wrong)), Error) << wrong;
  }
}

TEST_F(FlightJournalFile, ResumesWithNamesThatAreNotUtf8) {
  const Provenance provenance{{"source", "fl\xfcg"}};
  { FlightJournal::begin(file_, provenance).append(frame_of(0, {})); }
  EXPECT_EQ(FlightJournal::resume(file_, provenance).frames(), 1);
  EXPECT_THROW(FlightJournal::resume(file_, {{"source", "flug"}}), Error);
  EXPECT_EQ(valid_utf8("a\xff"
                       "b\xc3\xbc"),
            "a\xef\xbf\xbd"
            "b\xc3\xbc");
}

TEST_F(FlightJournalFile, ResumesAfterCutLine) {
  const Provenance provenance{{"source", "a"}};
  {
    FlightJournal journal = FlightJournal::begin(file_, provenance);
    journal.append(frame_of(0, {}));
    journal.append(frame_of(1, {pothole(1, 1)}));
  }
  const std::string whole = text_of(file_);
  for (const std::size_t missing : {std::size_t{1}, std::size_t{2}, std::size_t{200}}) {
    fs::resize_file(file_, whole.size() - missing);
    FlightJournal journal = FlightJournal::resume(file_, provenance);
    EXPECT_EQ(journal.frames(), 1);
    EXPECT_EQ(journal.last()->index, 0);
    journal.append(frame_of(1, {pothole(1, 1)}));
    EXPECT_EQ(text_of(file_), whole);
  }
  int seen = 0;
  read_flight_journal(file_, [&](const FlightFrame& frame) { EXPECT_EQ(frame.index, seen++); });
  EXPECT_EQ(seen, 2);
}

TEST_F(FlightJournalFile, RejectsOtherHeader) {
  { FlightJournal::begin(file_, {{"source", "a"}, {"--every", "1"}}); }
  EXPECT_EQ(FlightJournal::resume(file_, {{"source", "a"}, {"--every", "1"}}).frames(), 0);
  try {
    FlightJournal::resume(file_, {{"source", "a"}, {"--every", "2"}});
    FAIL() << "other provenance were taken";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("--every \"1\", not \"2\""), std::string::npos) << error.what();
  }
  std::ofstream(file_, std::ios::app) << "no frame\n";
  try {
    FlightJournal::resume(file_, {{"source", "a"}});
    FAIL() << "a line that is no frame was taken";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find(file_.string() + ", line 2: "), std::string::npos) << error.what();
  }
  std::ofstream(file_) << "something else\n";
  EXPECT_THROW(FlightJournal::resume(file_, {}), Error);
  fs::remove(file_);
  EXPECT_THROW(FlightJournal::resume(file_, {}), Error);
}

TEST(FlightTables, QuotesCommasAndLeavesUnknownEmpty) {
  FlightFrame frame = frame_of(3, {});
  frame.name = "a,b";
  frame.status = FrameStatus::rejected;
  frame.reason = "no \"right\" image";
  const std::string row = frames_csv_row(frame);
  EXPECT_EQ(row.substr(0, 17), "3,\"a,b\",,rejected");
  EXPECT_NE(row.find("\"no \"\"right\"\" image\"\r\n"), std::string::npos) << row;
  const auto commas = [](const std::string& line) { return std::count(line.begin(), line.end(), ','); };
  EXPECT_EQ(commas(row), commas(frames_csv_names()) + 1);  // the one in the name
  const FlightFrame damaged = frame_of(3, {pothole(1, 1), pothole(90, 1)});
  const std::string rows = flight_damages_csv_rows(damaged, {4, 5});
  EXPECT_EQ(rows.substr(0, 6), "4,3,3,");
  EXPECT_EQ(std::count(rows.begin(), rows.end(), '\n'), 2);
  EXPECT_EQ(commas(rows), 2 * commas(flight_damages_csv_names()));
}

TEST(FlightInventory, JoinsMovingDamage) {
  FlightInventory inventory;
  for (int i = 0; i < 5; ++i) {
    const std::vector<std::int64_t> ids =
        inventory.add(frame_of(i, {pothole(100, 50 + 25 * i, 0.05, 0.01 - 0.001 * i), pothole(300, 50 + 25 * i)}));
    EXPECT_EQ(ids, (std::vector<std::int64_t>{1, 2}));
  }
  ASSERT_EQ(inventory.damages().size(), 2U);
  EXPECT_EQ(inventory.damages()[0].sightings, 5);
  EXPECT_EQ(inventory.damages()[0].frame, 4) << "the least error";
  EXPECT_EQ(inventory.damages()[1].frame, 0) << "the first of equals";
}

TEST(FlightInventory, LearnsImageMotion) {
  FlightInventory inventory;
  int v = 20;
  // Steps of 45 px: boxes of 40 px do not overlap, once the motion has been learned from steps that grow.
  for (const int step : {0, 20, 30, 38, 45, 45, 45}) {
    v += step;
    EXPECT_EQ(inventory.add(frame_of(v, {pothole(100, v)})), std::vector<std::int64_t>{1}) << v;
  }
}

TEST(FlightInventory, BridgesOneMissedFrameOnly) {
  FlightInventory inventory;
  inventory.add(frame_of(0, {pothole(100, 100)}));
  inventory.add(frame_of(1, {}));
  EXPECT_EQ(inventory.add(frame_of(2, {pothole(100, 100)})), std::vector<std::int64_t>{1});
  for (int i = 3; i < 6; ++i) inventory.add(frame_of(i, {}));
  EXPECT_EQ(inventory.add(frame_of(6, {pothole(100, 100)})), std::vector<std::int64_t>{2});
  Damage bump = pothole(100, 100);
  bump.kind = DamageKind::protrusion;
  EXPECT_EQ(inventory.add(frame_of(7, {bump})), std::vector<std::int64_t>{3}) << "a bump is no pothole";
}

TEST(FlightInventory, CutStartsNewDamages) {
  FlightInventory inventory;
  inventory.add(frame_of(0, {pothole(100, 100)}));
  FlightFrame cut = frame_of(1, {pothole(100, 100)});
  cut.road_status = RoadStatus::found;
  EXPECT_EQ(inventory.add(cut), std::vector<std::int64_t>{2});
  FlightFrame refused = frame_of(2, {});
  refused.status = FrameStatus::rejected;
  refused.road_status = RoadStatus::found;
  inventory.add(refused);
  EXPECT_EQ(inventory.add(frame_of(3, {pothole(100, 100)})), std::vector<std::int64_t>{2})
      << "over a frame that is missing";
}

TEST(FlightInventory, PrefersWholeSightingsAndSortsBySeverity) {
  FlightInventory inventory;
  Damage cut = pothole(100, 100, 0.05, 0.0001);
  cut.cut_by_border = true;
  inventory.add(frame_of(0, {cut, pothole(300, 100, 0.03)}));
  inventory.add(frame_of(1, {pothole(100, 100, 0.04, 0.002), pothole(300, 100, 0.03)}));
  EXPECT_EQ(inventory.damages()[0].frame, 1);
  Damage deep = pothole(400, 300, 0.02);
  deep.metrics->severity = Severity::high;
  inventory.add(frame_of(2, {deep}));
  const std::vector<RoadDamage> worst = inventory.worst(2);
  ASSERT_EQ(worst.size(), 2U);
  EXPECT_EQ(worst[0].id, 3) << "severity before depth";
  EXPECT_EQ(worst[1].id, 1);
}

TEST(FlightReport, IsCompleteAndSelfContained) {
  DamageMap map = make_empty_damage_map(64, 48, "");
  Damage damage = pothole(30, 24);
  map.damages = {damage};
  for (int v = 10; v < 30; ++v) {
    for (int u = 20; u < 40; ++u) map.ids(u, v) = 1;
  }
  Frame left;
  left.width = 64;
  left.height = 48;
  left.bytes.assign(64 * 48, 120);
  FlightReportInput input;
  input.title = "a <flight>";
  input.properties = {{"Frames", "3"}};
  input.notices = {"1 of 3 frames have no result"};
  input.curves = {{0, 1, 2}, true, {1, FlightFrame::unknown, 2}, {3, 3, 3}, {0.1, 0.2, 0.1}};
  input.thumbnails = {{"first", frame_thumbnail(left.view(), map)}};
  input.worst.resize(1);
  input.worst[0].damage = {7, 3, 1, "frame 1", 0.5, damage};
  input.worst[0].jpeg = damage_picture(left.view(), map, damage);
  input.damages = 12;
  input.metric = true;
  const std::string html = flight_report(input);
  for (const char* part :
       {"a &lt;flight&gt;", "1 of 3 frames", "The worst 1 of 12", "50.0\u00a0±\u00a01.0", "frame 1", "chip medium",
        "alt=\"Roll, roll, deg\"", "alt=\"Height above the road, height, m\"", "data:image/jpeg;base64,"}) {
    EXPECT_NE(html.find(part), std::string::npos) << part;
  }
  EXPECT_EQ(html.find("http"), std::string::npos);
  EXPECT_EQ(html.find("{{"), std::string::npos) << "a place that was not filled";
  input.worst.clear();
  input.damages = 0;
  input.metric = false;
  const std::string clean = flight_report(input);
  EXPECT_NE(clean.find("No damage found"), std::string::npos);
  EXPECT_NE(clean.find("Pixels only"), std::string::npos);
}

}  // namespace
}  // namespace roadstereo::io
