// `map` from outside.

#include "tests/cli/command_test.hpp"

namespace roadstereo {
namespace {

class MapCommand : public CommandTest {
 protected:
  void make_flight(const std::string& size) const {
    const Outcome outcome = run("synth --scene nadir --frames 2 --flight roll=2,pitch=0,climb=0.1,step=0.1 --size " +
                                size + " --output flight --quiet");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  }
  Outcome map(const std::string& arguments) const {
    return run("map flight --calibration flight/calibration.yaml --output map " + arguments);
  }
};

// The scene has a pothole of 0.35 m radius at (0.35, 0.15), 0.085 m deep with its roughness (truth.json), another one
// and a crack. The map's origin is the foot of the first camera, which is that of the road.
TEST_F(MapCommand, MapsFlightWithTruePoses) {
  make_flight("480x270");
  const Outcome outcome = map("--trajectory flight/trajectory_kitti.txt --json --quiet");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const nlohmann::json result = json_file("map/map.json");
  EXPECT_EQ(result["mapped"], 2);
  ASSERT_GE(result["damages"].size(), 1U);
  const nlohmann::json& deepest = result["damages"][0];
  EXPECT_NEAR(deepest["x_m"], 0.35, 0.05);
  EXPECT_NEAR(deepest["y_m"], 0.15, 0.05);
  const double std_error = deepest["max_depth_m"]["std_error"];
  EXPECT_NEAR(deepest["max_depth_m"]["value"].get<double>(), 0.085, 2 * std_error);
  EXPECT_LT(std_error, 0.012);
  EXPECT_EQ(deepest["sightings"], 2);
  for (const char* name : {"orthophoto.tif", "height.tif", "sigma.tif", "views.tif", "damages.csv", "sightings.csv",
                           "transverse.csv", "longitudinal.csv", "roughness.csv"}) {
    EXPECT_TRUE(std::filesystem::exists(folder_ / "map" / name)) << name;
  }
  EXPECT_FALSE(std::filesystem::exists(folder_ / "map" / ".tiles"));
}

TEST_F(MapCommand, NamesWhatIsMissing) {
  make_flight("160x90");
  expect_complaint(map("--trajectory none.txt"), "none.txt");
  write("short.txt", std::string("1 0 0 0 0 1 0 0 0 0 1\n"));
  expect_complaint(map("--trajectory short.txt"), "12");
  expect_complaint(map("--trajectory flight/trajectory_kitti.txt --cell 100"), "--cell is 100");
  std::string poses;
  for (int i = 0; i < 9; ++i) poses += "1 0 0 0 0 1 0 0 0 0 1 0\n";
  write("long.txt", poses);
  expect_complaint(map("--trajectory long.txt"), "has 2 frames");
}

}  // namespace
}  // namespace roadstereo
