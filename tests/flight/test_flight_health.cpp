// What only a recording tells of its rig: `health` of summary.json.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "flight/flight_health.hpp"
#include "roadstereo/io/image_file.hpp"
#include "tests/cli/command_test.hpp"

namespace roadstereo {
namespace {

class FlightHealthCommand : public CommandTest {
 protected:
  /// Ids of the findings of the flight in a folder, each followed by a blank. Options may follow the folder.
  std::string findings_of(const std::string& source) {
    const Outcome outcome =
        run("inspect " + source + " --output " + source.substr(0, source.find(' ')) + "_out --json");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    health_ = nlohmann::json::parse(outcome.out)["health"];
    std::string ids;
    for (const auto& finding : health_["findings"]) ids += finding["id"].get<std::string>() + " ";
    return ids;
  }

  nlohmann::json health_;
};

/// Of 51 frames one, or every second, shows enough road to tell a bent field of disparities.
TEST(FlightHealth, OneFrameSaysNothingOfRecording) {
  for (const int every : {100, 2}) {
    cli::FlightHealth health;
    for (int i = 0; i < 51; ++i) {
      io::FlightFrame frame;
      frame.time_s = 0.1 * i;
      frame.health.noise_px = 0.05;
      frame.health.threshold_sigma = 5;
      if (i % every == 0) frame.health.bowl_px = 0.7;
      health.add(frame);
    }
    const std::vector<HealthFinding> findings = health.findings();
    EXPECT_EQ(std::any_of(findings.begin(), findings.end(), [](const auto& one) { return one.id == "distortion"; }),
              every == 2);
  }
}

/// Darkens six discs of the picture as dirt on the lens does.
std::vector<std::uint8_t> with_specks(const std::filesystem::path& file) {
  constexpr double specks[][3] = {{50, 20, 5}, {160, 40, 6}, {280, 60, 5}, {90, 100, 6}, {220, 120, 8}, {140, 150, 5}};
  Frame frame = io::read_frame(file.string());
  for (const auto& [at_u, at_v, radius] : specks) {
    for (int v = 0; v < frame.height; ++v) {
      for (int u = 0; u < frame.width; ++u) {
        if (std::hypot(u - at_u, v - at_v) > radius) continue;
        std::uint8_t& level = frame.bytes[static_cast<std::size_t>(v * frame.width + u)];
        level = static_cast<std::uint8_t>(0.2 * level + 0.8 * 20);
      }
    }
  }
  return io::encode_png(frame.view());
}

TEST_F(FlightHealthCommand, NamesSpecksOfOneLens) {
  const Outcome made = run("synth --scene uav --size 320x180 --frames 21 --flight default --output flight --quiet");
  ASSERT_EQ(made.exit_code, 0) << made.err;
  EXPECT_EQ(findings_of("flight").find("spots"), std::string::npos);
  EXPECT_EQ(health_["left_spots"]["dirt"], 0);
  for (const auto& entry : std::filesystem::directory_iterator(folder_ / "flight/left")) {
    write("flight/left/" + entry.path().filename().string(), with_specks(entry.path()));
  }
  EXPECT_NE(findings_of("flight").find("left-spots "), std::string::npos);
  EXPECT_EQ(health_["left_spots"]["dirt"], 6);
  EXPECT_EQ(health_["right_spots"]["dirt"], 0);
  EXPECT_NEAR(health_["left_spots"]["largest_u"], 220, 2);
  EXPECT_NEAR(health_["left_spots"]["largest_v"], 120, 2);
  EXPECT_EQ(health_["frames_with"]["left-spots"], 2);  // from the twentieth frame on
  const std::string report = read_text(folder_ / "flight_out/report.html");
  EXPECT_NE(report.find("6 places of the left picture"), std::string::npos);
}

TEST_F(FlightHealthCommand, PauseIsNoLoss) {
  const Outcome made = run("synth --scene uav --size 320x180 --frames 12 --output flight --quiet");
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const auto write_times = [this](double pause_s) {
    std::string times;
    for (int i = 0; i < 12; ++i) times += std::to_string(i / 30.0 + (i < 6 ? 0 : pause_s)) + "\n";
    write("flight/times.txt", times);
  };
  write_times(60);
  findings_of("flight");
  EXPECT_EQ(health_["lost_share"], 0);
  write_times(0.1);  // three periods
  EXPECT_NE(findings_of("flight").find("lost-pairs"), std::string::npos);
}

/// A pair that is there but without a result is lost once, whether it has a time or not, and so is one whose time
/// cannot be right.
TEST_F(FlightHealthCommand, PairWithoutTimeIsLostOnce) {
  const Outcome made = run("synth --scene uav --size 320x180 --frames 12 --output flight --quiet");
  ASSERT_EQ(made.exit_code, 0) << made.err;
  std::string times;
  for (int i = 0; i < 12; ++i) times += std::to_string((i == 5 ? 3 : i) / 30.0) + "\n";
  write("flight/times.txt", times);
  EXPECT_EQ(findings_of("flight").find("lost-pairs"), std::string::npos);
  EXPECT_EQ(health_["lost_share"], 0);
}

TEST_F(FlightHealthCommand, TellsWrongOffsetOfDisparities) {
  ASSERT_EQ(run("synth --scene uav --size 320x180 --frames 24 --quiet --output flight --flight step=0.5").exit_code, 0);
  EXPECT_EQ(findings_of("flight --trajectory"), "");
  const std::string calibration = read_text(folder_ / "flight/calibration.yaml");
  write("flight/calibration.yaml", calibration + "disparity_offset_px: 2\n");
  ASSERT_NE(findings_of("flight --trajectory").find("disparity-offset"), std::string::npos);
  const nlohmann::json& finding = health_["findings"][0];
  EXPECT_NEAR(finding["value"], 2, 0.1);
  EXPECT_NE(finding["text"].get<std::string>().find("too large"), std::string::npos);
}

TEST_F(FlightHealthCommand, TellsHowLongShutterRolls) {
  const std::string synth = "synth --scene uav --size 320x180 --frames 24 --rate 20 --quiet --output rolling";
  ASSERT_EQ(run(synth + " --flight step=0.5,shutter=0.4").exit_code, 0);
  ASSERT_EQ(findings_of("rolling --trajectory"), "rolling-shutter ");
  const nlohmann::json& finding = health_["findings"][0];
  EXPECT_EQ(finding["unit"], "ms");
  EXPECT_NEAR(finding["value"], 0.4 * 50, 2);
  EXPECT_NE(read_text(folder_ / "rolling_out/report.html").find("Health: rolling shutter"), std::string::npos);
}

}  // namespace
}  // namespace roadstereo
