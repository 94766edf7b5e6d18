// What a flight leaves behind: journal, tables, the report.
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "io/report/summary.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/io/flight_inventory.hpp"
#include "roadstereo/io/flight_journal.hpp"
#include "roadstereo/io/flight_pictures.hpp"
#include "roadstereo/io/flight_report.hpp"
#include "roadstereo/io/flight_tables.hpp"
#include "tests/io/flight/flight_frames.hpp"

namespace roadstereo::io {
namespace {

namespace fs = std::filesystem;

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
  frame.damages[1].ends_search = true;
  frame.time_s = 1403636579.763555584;
  frame.roll_rad = -0.1 / 3;
  frame.road = {1.0 / 3, 2.0 / 7, -1e-17};
  frame.pose = {2, {1, 0, 0, 1.0 / 3, 0, 1, 0, 0, 0, 0, 1, 0}};
  frame.warnings = {"a \"quoted\" word", "line\nend"};
  frame.health.row_scale = 1.0 / 3;
  frame.static_mask = {true, 39, 0.1, true};
  frame.pipeline_state = {
      640, 360, TrackedRoad{{1.0 / 3, 1e-300, 5}, 0.1, 0.7}, 1.0 / 7, {-0.3, 1e-5, 1.0 / 9, 320.5, 180}};
  const FlightFrame back = read_flight_frame(flight_frame_json(frame));
  EXPECT_EQ(back.index, 7);
  EXPECT_EQ(back.time_s, frame.time_s);
  EXPECT_EQ(back.roll_rad, frame.roll_rad);
  EXPECT_EQ(back.road.a0, frame.road.a0);
  EXPECT_EQ(back.health.row_scale, frame.health.row_scale);
  EXPECT_TRUE(std::isnan(back.health.gain));
  EXPECT_EQ(back.road.a2, frame.road.a2);
  EXPECT_TRUE(std::isnan(back.height_m));
  EXPECT_EQ(back.pose->piece, 2);
  EXPECT_EQ(back.pose->road_to_world, frame.pose->road_to_world);
  EXPECT_EQ(back.warnings, frame.warnings);
  EXPECT_TRUE(back.static_mask.judged);
  EXPECT_EQ(back.static_mask.frame, 39);
  EXPECT_EQ(back.static_mask.share, 0.1);
  EXPECT_TRUE(back.static_mask.applied);
  EXPECT_EQ(back.pipeline_state.road->model.a1, 1e-300);
  EXPECT_EQ(back.pipeline_state.road->inlier_share, 0.1);
  EXPECT_EQ(back.pipeline_state.road->correlation, 0.7);
  EXPECT_EQ(back.pipeline_state.misalignment.rows_px, -0.3);
  EXPECT_EQ(back.pipeline_state.misalignment.turn_rad, 1e-5);
  EXPECT_EQ(back.pipeline_state.misalignment.row_scale, 1.0 / 9);
  EXPECT_EQ(back.pipeline_state.misalignment.cx_px, 320.5);
  ASSERT_EQ(back.damages.size(), 2U);
  EXPECT_EQ(back.damages[0].metrics->max_depth_m.value, 0.1 / 3);
  EXPECT_EQ(back.damages[0].metrics->severity, Severity::medium);
  EXPECT_FALSE(back.damages[1].metrics);
  EXPECT_EQ(back.damages[1].kind, DamageKind::protrusion);
  EXPECT_FALSE(back.damages[0].ends_search);
  EXPECT_TRUE(back.damages[1].ends_search);
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

TEST_F(FlightJournalFile, BrokenLineIsToldWhenItIsRead) {
  {
    FlightJournal journal = FlightJournal::begin(file_, {});
    journal.append(frame_of(0, {}));
  }
  std::ofstream(file_, std::ios::app) << "no frame\n" << flight_frame_json(frame_of(2, {})) << '\n';
  const FlightJournal journal = FlightJournal::resume(file_, {});
  EXPECT_EQ(journal.frames(), 3);
  EXPECT_EQ(journal.last()->index, 2);
  try {
    journal.for_each([](const FlightFrame&) {});
    FAIL() << "a line that is no frame was taken";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find(file_.string() + ", line 3: "), std::string::npos) << error.what();
  }
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

// A folder can be opened, but not read.
TEST_F(FlightJournalFile, ReadErrorIsNoEnd) {
  fs::create_directory(file_);
  EXPECT_THROW(FlightJournal::resume(file_, {}), SystemError);
  EXPECT_THROW(read_flight_journal(file_, [](const FlightFrame&) {}), SystemError);
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
  const std::string rows = sightings_csv_rows(damaged, {4, 5});
  EXPECT_EQ(rows.substr(0, 6), "4,3,3,");
  EXPECT_EQ(std::count(rows.begin(), rows.end(), '\n'), 2);
  EXPECT_EQ(commas(rows), 2 * commas(sightings_csv_names()));
}

TEST(FlightTables, FormulasOfNamesAreDefused) {
  FlightFrame frame = frame_of(3, {});
  frame.name = "=cmd|' /C calc'!A0.png";
  EXPECT_EQ(frames_csv_row(frame).substr(0, 8), "3,'=cmd|");
  frame.name = "-2.png";
  EXPECT_EQ(frames_csv_row(frame).substr(0, 6), "3,'-2.");
}

/// A grey frame of 64×48 pixels with a damage in it.
struct PicturesOfDamage {
  explicit PicturesOfDamage(const Damage& damage) {
    map.damages = {damage};
    for (int v = 10; v < 30; ++v) std::fill_n(map.ids.row(v) + 20, 20, std::uint16_t{1});
    left.width = 64;
    left.height = 48;
    left.bytes.assign(64 * 48, 120);
    pictures.left = left.view();
  }

  DamageMap map = make_empty_damage_map(64, 48, "");
  Frame left;
  DamageReportInput pictures{map};
};

/// 12 bits in 16: samples of 468 are 468 · 255 / 4095 = 29, whatever else is in the frame. JPEG rounds.
TEST(FlightPictures, WhiteIsThatOfProcessing) {
  const Damage damage = pothole(30, 24);
  const DamageMap map = make_empty_damage_map(64, 48, "");
  for (const unsigned brightest : {468U, 1100U}) {
    Frame left{std::vector<std::uint8_t>(std::size_t{2} * 64 * 48), 64, 48, SampleType::u16};
    for (std::size_t i = 0; i < left.bytes.size(); i += 2) {
      const unsigned sample = i == 0 ? brightest : 468U;
      left.bytes[i] = static_cast<std::uint8_t>(sample & 255U);
      left.bytes[i + 1] = static_cast<std::uint8_t>(sample >> 8U);
    }
    for (const std::vector<std::uint8_t>& jpeg :
         {frame_thumbnail(left.view(), 4095, map), damage_picture(left.view(), 4095, map, damage)}) {
      EXPECT_NEAR(cv::mean(cv::imdecode(jpeg, cv::IMREAD_GRAYSCALE))[0], 29, 2) << brightest;
    }
  }
}

TEST(FlightReport, LegendHasLimitsOfScheme) {
  SeverityScheme scheme = astm_d6433();
  scheme.tables[0].depths_m = {0.0005, 0.0125, 0.1};
  const std::string html = severity_legend(scheme);
  for (const char* limits : {">0.5 – 12.5 mm<", ">12.5 – 100 mm<", ">over 100 mm<", ">100 – 200 mm wide<"}) {
    EXPECT_NE(html.find(limits), std::string::npos) << limits << " in " << html;
  }
}

TEST(FlightReport, IsCompleteAndSelfContained) {
  Damage damage = pothole(30, 24);
  const PicturesOfDamage frame(damage);
  FlightReportInput input;
  input.title = "a <flight>";
  input.head = {{"Road", "B 27 <north>"}};
  input.properties = {{"Frames", "3"}};
  input.notices = {"1 of 3 frames have no result"};
  input.curves = {{0, 1, 2}, true, {1, FlightFrame::unknown, 2}, {3, 3, 3}, {0.1, 0.2, 0.1}};
  input.inspected = 3;
  input.thumbnails = {{"first", frame_thumbnail(frame.left.view(), 0, frame.map)}};
  input.damages.resize(1);
  RoadDamage& known = input.damages[0].damage;
  known.id = 7;
  known.sightings = 3;
  known.frame_name = "frame 1";
  known.best = damage;
  known.position = GeoPosition{48.5, 9.25, 100, 0};
  known.station_m = 33;
  input.damages[0].section = road_damage_section(frame.pictures, damage, 7);
  RoadDamage candidate = known;
  candidate.id = 8;
  input.candidates = {candidate};
  input.track_deg = {{9.249, 48.5}, {9.25, 48.5}, {9.251, 48.5}};
  input.segments = {{20, 40, 5, 5, 1, 0.25, 7, 0.01, 2}};
  input.metric = true;
  const std::string html = flight_report(input);
  for (const char* part :
       {"a &lt;flight&gt;", "B 27 &lt;north&gt;", "1 of 3 frames", "50.0\u00a0±\u00a01.0", "frame 1", "chip medium",
        "aria-label=\"roll, °\"", "48.500000, 9.250000", "id=\"damage-7\"", "href=\"#damage-7\"", "class=\"road-map\"",
        "id=\"segments\"", "id=\"candidates\"", "seen in", "data:image/jpeg;base64,"}) {
    EXPECT_NE(html.find(part), std::string::npos) << part;
  }
  EXPECT_EQ(html.find("http"), std::string::npos);
  EXPECT_EQ(html.find("{{"), std::string::npos) << "a place that was not filled";
  EXPECT_LT(html.find("Damages by severity"), html.find("σ_d")) << "the appendix is last";
  // 0.002° of longitude at 48.5° are 147.4 m on 628 px: a bar of 20 m is at most a fifth of 720 px (33.8 m), 85.2 px.
  EXPECT_NE(html.find("h85.2\"/>"), std::string::npos);
  EXPECT_NE(html.find(">20 m<"), std::string::npos);
  EXPECT_EQ(html.find("<span id=\"damage-7\""), std::string::npos);
  input.damages[0].section.clear();
  EXPECT_NE(flight_report(input).find("<span id=\"damage-7\""), std::string::npos) << "what links lead to";
  input.damages.clear();
  input.candidates.clear();
  input.metric = false;
  const std::string clean = flight_report(input);
  EXPECT_NE(clean.find("No damage found"), std::string::npos);
  EXPECT_NE(clean.find("Pixels only"), std::string::npos);
  input.inspected = 3;
  input.untrusted = 2;
  EXPECT_NE(flight_report(input).find("No damage found in 1 of 3 frames"), std::string::npos);
  input.limits.doubts = {"the rows differ by 9 px"};
  const std::string doubtful = flight_report(input);
  EXPECT_NE(doubtful.find("not inspected reliably"), std::string::npos);
  EXPECT_NE(doubtful.find("<li>the rows differ by 9 px.</li>"), std::string::npos);
  EXPECT_EQ(doubtful.find("notice good"), std::string::npos);
  input.limits.doubts.clear();
  input.untrusted = 0;
  input.flawed = true;
  EXPECT_EQ(flight_report(input).find("notice good"), std::string::npos);
  input.flawed = false;
  EXPECT_NE(flight_report(input).find("notice good"), std::string::npos);
  ReportedMap road_map;
  road_map.damages.resize(2);
  for (RoadDamageRecord& record : road_map.damages) record.best.damage = damage;
  input.map = road_map;
  const std::string in_map = flight_report(input);
  EXPECT_EQ(in_map.find("No damage found.</strong>"), std::string::npos);
  EXPECT_NE(in_map.find("Their map shows 2"), std::string::npos);
  input.map.reset();
  input.inspected = 0;
  const std::string nothing = flight_report(input);
  EXPECT_EQ(nothing.find("No damage found"), std::string::npos);
  EXPECT_NE(nothing.find("Not inspected"), std::string::npos);
}

// Of a rut that the border cuts in each of nine frames one shows 2.1 m², all together 8.5 m²: neither is all of it.
TEST(FlightReport, CutDamageHasSizeOfAllFrames) {
  Damage in_frame = pothole(30, 24);
  in_frame.cut_by_border = true;
  in_frame.metrics->area_m2 = {2.1, 0.4};
  in_frame.metrics->volume_m3 = {0.02, 0.004};
  in_frame.metrics->unit = DistressUnit::square_metre;
  in_frame.metrics->quantity = 2.1;
  const PicturesOfDamage frame(in_frame);
  FlightReportInput input;
  input.inspected = 9;
  input.metric = true;
  input.damages.resize(1);
  RoadDamage& known = input.damages[0].damage;
  known.id = 7;
  known.sightings = 9;
  known.frame_name = "frame 1";
  known.best = in_frame;
  known.best.metrics->area_m2 = {8.5, 1.5};
  known.best.metrics->volume_m3 = {0.081, 0.015};
  known.best.metrics->length_m = 11.3;
  known.best.metrics->quantity = 8.5;
  input.damages[0].section = road_damage_section(frame.pictures, in_frame, 7);
  const std::string html = flight_report(input);
  const auto property = [](const std::string& name, const std::string& value) {
    return "<dt>" + name + "</dt><dd>≥\u00a0" + value + "</dd>";
  };
  for (const std::string& part :
       {property("area over all frames", "8.5\u00a0±\u00a01.5\u00a0m²"),
        property("volume over all frames", "81\u00a0±\u00a015\u00a0L"),
        property("length over all frames", "11.3\u00a0m"),
        property("area in this frame", "2.1\u00a0±\u00a00.4\u00a0m²"),
        property("volume in this frame", "20\u00a0±\u00a04\u00a0L"), std::string(">≥\u00a08.5\u00a0±\u00a01.5</td>"),
        std::string(">≥\u00a08.50\u00a0m²</td>"), std::string("missing volume ≥\u00a081\u00a0±\u00a015\u00a0L")}) {
    EXPECT_NE(html.find(part), std::string::npos) << part;
  }
  known.best.cut_by_border = in_frame.cut_by_border = false;
  input.damages[0].section = road_damage_section(frame.pictures, in_frame, 7);
  const std::string whole = flight_report(input);
  EXPECT_NE(whole.find("<dt>area</dt><dd>2.1\u00a0±\u00a00.4"), std::string::npos);
  EXPECT_EQ(whole.find("over all frames"), std::string::npos);
  EXPECT_EQ(whole.find("≥\u00a0"), std::string::npos);
}

}  // namespace
}  // namespace roadstereo::io
