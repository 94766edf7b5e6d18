// `map` from outside.

#include "tests/cli/command_test.hpp"

namespace roadstereo {
namespace {

class MapCommand : public CommandTest {
 protected:
  void make_flight() const {
    const Outcome outcome =
        run("synth --scene nadir --size 320x180 --frames 4 --flight roll=2,pitch=0,climb=0.1,step=0.1 --output flight "
            "--quiet");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  }
  Outcome map(const std::string& arguments) const {
    return run("map flight --calibration flight/calibration.yaml --output map " + arguments);
  }
};

// The scene has a pothole of 0.35 m radius and 0.08 m depth at (0.35, 0.15), another one and a crack. The map's origin
// is the foot of the first camera, which is that of the road.
TEST_F(MapCommand, MapsFlightWithTruePoses) {
  make_flight();
  const Outcome outcome = map("--trajectory flight/trajectory_kitti.txt --json --quiet");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const nlohmann::json result = json_file("map/map.json");
  EXPECT_EQ(result["mapped"], 4);
  ASSERT_GE(result["damages"].size(), 1U);
  const nlohmann::json& deepest = result["damages"][0];
  EXPECT_NEAR(deepest["x_m"], 0.35, 0.05);
  EXPECT_NEAR(deepest["y_m"], 0.15, 0.05);
  EXPECT_NEAR(deepest["max_depth_m"]["value"].get<double>(), 0.09,
              3 * deepest["max_depth_m"]["std_error"].get<double>());
  EXPECT_EQ(deepest["sightings"], 4);
  for (const char* name : {"orthophoto.tif", "height.tif", "sigma.tif", "views.tif", "damages.csv", "sightings.csv",
                           "transverse.csv", "longitudinal.csv", "roughness.csv"}) {
    EXPECT_TRUE(std::filesystem::exists(folder_ / "map" / name)) << name;
  }
  EXPECT_FALSE(std::filesystem::exists(folder_ / "map" / ".tiles"));
}

TEST_F(MapCommand, NamesWhatIsMissing) {
  make_flight();
  expect_complaint(map("--trajectory none.txt"), "none.txt");
  write("short.txt", std::string("1 0 0 0 0 1 0 0 0 0 1\n"));
  expect_complaint(map("--trajectory short.txt"), "12");
  expect_complaint(map("--trajectory flight/trajectory_kitti.txt --cell 100"), "--cell is 100");
  std::string poses;
  for (int i = 0; i < 9; ++i) poses += "1 0 0 0 0 1 0 0 0 0 1 0\n";
  write("long.txt", poses);
  expect_complaint(map("--trajectory long.txt"), "has 4 frames");
}

}  // namespace
}  // namespace roadstereo
