// The bias of a rig from a recording of it, and back into `inspect`, `map` and `live`.

#include <array>
#include <cmath>
#include <filesystem>
#include <string>

#include "evaluation/image_faults.hpp"
#include "roadstereo/io/image_file.hpp"
#include "roadstereo/io/rig_bias_file.hpp"
#include "tests/cli/command_test.hpp"

namespace roadstereo {
namespace {

class RigBiasCommand : public CommandTest {
 protected:
  static constexpr double focal_px = 186.67, k = 0.008;

  /// A flight over an intact road, whose right lens moves points along the rows by f·k·x·r².
  void make_flight(int frames) const {
    const Outcome made = run("synth --scene flat --size 320x180 --frames " + std::to_string(frames) +
                             " --flight roll=3,pitch=2,climb=0.2,step=0.15 --output flight --quiet");
    ASSERT_EQ(made.exit_code, 0) << made.err;
    for (const auto& entry : std::filesystem::directory_iterator(folder_ / "flight" / "right")) {
      const Frame frame = io::read_frame(entry.path().string());
      const Frame bent = io::warped(frame, [](double u, double v) {
        const double x = (u - 159.5) / focal_px, y = (v - 89.5) / focal_px;
        return std::array{u + focal_px * k * x * (x * x + y * y), v};
      });
      write("flight/right/" + entry.path().filename().string(), io::encode_png(bent.view()));
    }
  }
  Outcome inspect(const std::string& output, const std::string& arguments = "") const {
    return run("inspect flight --calibration flight/calibration.yaml --quiet --output " + output + " " + arguments);
  }
};

TEST_F(RigBiasCommand, IsFoundInFlightAndUndone) {
  make_flight(18);
  const Outcome first = inspect("first");
  ASSERT_EQ(first.exit_code, 0) << first.err;
  const nlohmann::json found = json_file("first/summary.json")["rig_bias"];
  EXPECT_EQ(found["frames"], 18);
  EXPECT_EQ(found["file"], "rig_bias.json");
  EXPECT_NE(read_text(folder_ / "first/report.html").find("Bias of the rig"), std::string::npos);
  const RigBias bias = io::read_rig_bias((folder_ / "first/rig_bias.json").string());
  // f·k·x³ has a coefficient of 186.67·0.008·(160/186.67)³ px; the right column lies a disparity of some 10 px further
  // left.
  EXPECT_NEAR(bias.value_px[6], 0.94, 0.15);
  const Outcome second = inspect("second", "--rig-bias first/rig_bias.json");
  ASSERT_EQ(second.exit_code, 0) << second.err;
  const nlohmann::json before = json_file("first/summary.json"), after = json_file("second/summary.json");
  EXPECT_EQ(after["inputs"]["rig_bias"], "../first/rig_bias.json");
  const double left_px = after["rig_bias"]["order"] == 0 ? 0 : after["rig_bias"]["rms_px"].get<double>();
  EXPECT_LT(left_px, 0.1 * bias.rms_px);
  EXPECT_LT(after["sigma_d_px"]["median"], 0.6 * before["sigma_d_px"]["median"].get<double>());
}

TEST_F(RigBiasCommand, IsTheSameAfterResume) {
  make_flight(17);
  ASSERT_EQ(inspect("whole").exit_code, 0);
  ASSERT_EQ(inspect("parts", "--to 9").exit_code, 0);
  const Outcome resumed = inspect("parts", "--resume");
  ASSERT_EQ(resumed.exit_code, 0) << resumed.err;
  const std::string whole = read_text(folder_ / "whole/rig_bias.json");
  EXPECT_FALSE(whole.empty());
  EXPECT_EQ(whole, read_text(folder_ / "parts/rig_bias.json"));
  expect_complaint(inspect("parts", "--resume --rig-bias whole/rig_bias.json"), "--rig-bias");
  expect_complaint(inspect("whole", "--rig-bias whole/rig_bias.json"), "would be overwritten");
}

TEST_F(RigBiasCommand, IsRefusedForAnotherRig) {
  make_flight(2);
  RigBias bias;
  bias.width = 640;
  bias.height = 360;
  bias.order = 2;
  bias.region_px = {0, 0, 639, 359};
  write("other.json", io::rig_bias_json(bias));
  const std::string size = "the rig bias is that of 640×360 pixels; the frames have 320×180";
  const std::string pair = "inspect flight/left/000000.png flight/right/000000.png --output pair --rig-bias ";
  expect_complaint(run(pair + "other.json"), size);
  expect_complaint(run(pair + "missing.json"), "missing.json: cannot be read");
  expect_complaint(inspect("out", "--rig-bias other.json"), size);
  const Outcome map =
      run("map flight --trajectory flight/trajectory_kitti.txt --calibration flight/calibration.yaml "
          "--output map --quiet --rig-bias other.json");
  EXPECT_NE(map.err.find(size), std::string::npos) << map.err;
  bias.width = 320;
  bias.height = 180;
  bias.region_px = {0, 0, 319, 179};
  write("own.json", io::rig_bias_json(bias));
  const Outcome own = run(pair + "own.json --calibration flight/calibration.yaml --quiet");
  EXPECT_EQ(own.exit_code, 0) << own.err;
  EXPECT_EQ(json_file("pair/result.json")["inputs"]["rig_bias"], "own.json");
}

}  // namespace
}  // namespace roadstereo
