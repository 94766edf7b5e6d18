// `map` from outside.

#include <cstdlib>
#include <filesystem>
#include <set>
#include <string>

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

using SlowMapCommand = MapCommand;

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
  EXPECT_NEAR(deepest["max_depth_m"]["value"].get<double>(), 0.085, 0.01);
  EXPECT_LT(std_error, 0.085 / 3);  // resolved
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
  expect_complaint(map("--trajectory flight/trajectory_kitti.txt --crs NOSUCH"), "--crs NOSUCH: GDAL does not know");
  expect_complaint(map("--trajectory flight/trajectory_kitti.txt --crs EPSG:4326"), "not projected");
}

TEST_F(MapCommand, SaysHowManyFramesHaveNoPose) {
  make_flight("160x90");
  const std::string poses = read_text(folder_ / "flight/trajectory_kitti.txt");
  write("one.txt", poses.substr(0, poses.find('\n') + 1));
  ASSERT_EQ(map("--trajectory one.txt --quiet").exit_code, 0);
  const nlohmann::json result = json_file("map/map.json");
  ASSERT_EQ(result["reasons"].size(), 1U);
  EXPECT_EQ(result["reasons"][0], "1 of 2 frames have no pose in one.txt");
}

// Frames 1 and 3 of five: no others were asked for.
TEST_F(MapCommand, FramesLeftOutByInspectNeedNoPose) {
  const Outcome made = run("synth --scene nadir --frames 5 --flight step=0.1 --size 256x144 --output flight --quiet");
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const Outcome outcome = run("inspect flight --map --from 1 --to 3 --every 2 --output run --quiet");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(json_file("run/map/map.json")["frames"], 2);
  EXPECT_TRUE(json_file("run/map/map.json")["reasons"].empty()) << json_file("run/map/map.json")["reasons"];
  ASSERT_EQ(run("map run --output map --quiet").exit_code, 0);
  EXPECT_TRUE(json_file("map/map.json")["reasons"].empty()) << json_file("map/map.json")["reasons"];
}

/// What a standing camera shows again and again says the same once more: the map is that of one frame of each place.
TEST_F(MapCommand, FramesOfStandingCameraCountOnce) {
  make_flight("320x180");
  const std::string poses = read_text(folder_ / "flight/trajectory_kitti.txt");
  const std::size_t second = poses.find('\n') + 1;
  std::string standing;
  int frame = 0;
  for (const auto& [of, times] : {std::pair{0, 4}, std::pair{1, 3}}) {
    for (int i = 0; i < times; ++i, ++frame) {
      for (const std::string side : {"left", "right"}) {
        std::filesystem::create_directories(folder_ / "light" / side);
        std::filesystem::copy(folder_ / "flight" / side / ("00000" + std::to_string(of) + ".png"),
                              folder_ / "light" / side / ("00000" + std::to_string(frame) + ".png"));
      }
      standing += of == 0 ? poses.substr(0, second) : poses.substr(second);
    }
  }
  write("light.txt", standing);
  ASSERT_EQ(map("--trajectory flight/trajectory_kitti.txt --quiet").exit_code, 0);
  const Outcome outcome =
      run("map light --calibration flight/calibration.yaml --trajectory light.txt --output once --quiet");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(json_file("once/map.json")["frames"], 7);
  EXPECT_EQ(json_file("once/map.json")["mapped"], 2);
  EXPECT_TRUE(read_text(folder_ / "map/height.tif") == read_text(folder_ / "once/height.tif"));
  EXPECT_TRUE(read_text(folder_ / "map/sigma.tif") == read_text(folder_ / "once/sigma.tif"));
}

// Six broken pictures, each with its own name, are one reason.
TEST_F(MapCommand, SaysReasonsOfFramesOnce) {
  const Outcome made = run("synth --scene nadir --frames 8 --flight step=0.1 --size 160x90 --output flight --quiet");
  ASSERT_EQ(made.exit_code, 0) << made.err;
  for (int i = 2; i < 8; ++i) write("flight/left/00000" + std::to_string(i) + ".png", "no picture");
  const Outcome outcome = map("--trajectory flight/trajectory_kitti.txt --quiet");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const nlohmann::json reasons = json_file("map/map.json")["reasons"];
  ASSERT_EQ(reasons.size(), 1U) << reasons;
  EXPECT_NE(reasons[0].dump().find("000002.png"), std::string::npos) << reasons;
  EXPECT_NE(reasons[0].dump().find(", and 5 more like it"), std::string::npos) << reasons;
}

// The number of frames is an estimate for bags and videos: what has been read counts.
TEST_F(MapCommand, SaysWhereRecordingEnds) {
  make_flight("160x90");
  const std::string poses = read_text(folder_ / "flight/trajectory_kitti.txt");
  const std::string first = poses.substr(0, poses.find('\n') + 1);
  write("long.txt", poses + first + first);
  const Outcome outcome = map("--trajectory long.txt --quiet");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const nlohmann::json result = json_file("map/map.json");
  EXPECT_GE(result["mapped"].get<int>(), 1);
  EXPECT_NE(result["reasons"].dump().find("\"flight ends before frame 2 of long.txt\""), std::string::npos)
      << result["reasons"];
}

// The same road with and without its potholes ("flat" has none); poses are true, so both days have one world.
TEST_F(SlowMapCommand, SaysWhatChangedBetweenDays) {
  for (const std::string scene : {"uav", "flat"}) {
    const Outcome made =
        run("synth --scene " + scene + " --frames 2 --flight step=0.1 --size 512x288 --output " + scene + " --quiet");
    ASSERT_EQ(made.exit_code, 0) << made.err;
  }
  const std::string poses = " --trajectory uav/trajectory_kitti.txt --trajectory flat/trajectory_kitti.txt";
  const Outcome outcome =
      run("map uav flat --calibration uav/calibration.yaml --day spring --day autumn --output days --quiet" + poses);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const nlohmann::json map = json_file("days/map.json");
  EXPECT_EQ(map["days"], nlohmann::json({"spring", "autumn"}));
  EXPECT_TRUE(map["damages"].empty());  // autumn has seen all of it
  ASSERT_GE(map["changes"].size(), 1U);
  const nlohmann::json& change = map["changes"][0];
  EXPECT_EQ(change["change"], "repaired");
  EXPECT_NEAR(change["x_m"], 0.45, 0.05);  // the larger pothole of the scene, 80 mm
  EXPECT_NEAR(change["y_m"], 1.35, 0.05);
  EXPECT_EQ(change["before_day"], "spring");
  EXPECT_TRUE(change["max_depth_after_m"]["value"].is_null());
  const std::string table = read_text(folder_ / "days/changes.csv");
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 1 + static_cast<std::ptrdiff_t>(map["changes"].size()));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "days/.tiles"));
  expect_complaint(run("map uav flat --calibration uav/calibration.yaml --day spring --output days" + poses), "1 days");
}

// 1 717 200 000 s is the first of June 2024, 0:00 UTC. The first pair of both recordings has no left image, which has
// its time.
TEST_F(MapCommand, DayIsThatOfFirstGoodPair) {
  make_flight("160x90");
  std::filesystem::remove(folder_ / "flight/left/000000.png");
  std::filesystem::copy(folder_ / "flight", folder_ / "later", std::filesystem::copy_options::recursive);
  write("flight/times.txt", std::string("1717200000\n"));
  write("later/times.txt", std::string("1717286400\n"));
  const Outcome outcome =
      run("map flight later --calibration flight/calibration.yaml --output map --quiet "
          "--trajectory flight/trajectory_kitti.txt --trajectory later/trajectory_kitti.txt");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(json_file("map/map.json")["days"], nlohmann::json({"2024-06-01", "2024-06-02"}));
}

TEST_F(MapCommand, RunIsMappedWithItsOwnOptions) {
  make_flight("256x144");
  ASSERT_EQ(run("inspect flight --trajectory --preset fast --output run --quiet").exit_code, 0);
  ASSERT_EQ(run("map run --output map --quiet").exit_code, 0);
  ASSERT_EQ(run("map flight --trajectory run/trajectory_kitti.txt --preset fast --output same --quiet").exit_code, 0);
  EXPECT_TRUE(read_text(folder_ / "map/height.tif") == read_text(folder_ / "same/height.tif"));
  EXPECT_EQ(json_file("run/summary.json")["inputs"]["source"][0], "../flight");
  expect_complaint(run("map run --preset paper --output map"), "--preset is for recordings");
  expect_complaint(run("map run --scope scene --output map"), "--scope is for recordings");
  expect_complaint(run("map run --rate 5 --output map"), "--rate is for recordings");
  expect_complaint(run("map run run --output map"), "those of their first cameras");
  expect_complaint(run("map run flight --output map"), "not both");
  expect_complaint(run("map run --output run"), "this folder has the results of a recording");
  std::string summary = read_text(folder_ / "run/summary.json");
  const std::string no_crs = "\"crs\": null";
  summary.replace(summary.find(no_crs), no_crs.size(), "\"crs\": \"EPSG:32660\"");
  write("run/summary.json", summary);
  expect_complaint(run("map run --crs EPSG:32632 --output map"), "run: the poses of this run are in EPSG:32660");
  std::filesystem::remove(folder_ / "run/trajectory_kitti.txt");
  expect_complaint(run("map run --output map"), "no trajectory");
  std::filesystem::remove(folder_ / "run/summary.json");
  expect_complaint(run("map run --output map"), "not finished");
}

/// A test with a map of 20 small frames, long enough for a checkpoint after 16.
class MapResume : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    const Outcome made = run("synth --scene uav --frames 20 --flight step=0.02 --size 160x90 --output flight --quiet");
    ASSERT_EQ(made.exit_code, 0) << made.err;
    const Outcome whole = run(command_ + "whole");
    ASSERT_EQ(whole.exit_code, 0) << whole.err;
  }
  void expect_whole(const std::string& name) const {
    const std::set<std::string> files = names_in(folder_ / "whole");
    EXPECT_TRUE(files.contains("map.json"));
    ASSERT_EQ(names_in(folder_ / name), files);
    for (const std::string& file : files) {
      EXPECT_TRUE(read_text(folder_ / "whole" / file) == read_text(folder_ / name / file)) << file;
    }
    EXPECT_FALSE(std::filesystem::exists(folder_ / name / ".tiles"));
  }

  const std::string command_ =
      "map flight --trajectory flight/trajectory_kitti.txt --preset fast --quiet --points --output ";
};

// By a kill after the checkpoint, and by a full disk before it.
TEST_F(MapResume, InterruptedMapIsContinuedBitForBit) {
  const std::string kill = "cd '" + folder_.string() + "' && { '" ROADSTEREO_BINARY "' " + command_ +
                           "killed & } 2>/dev/null; pid=$!; "
                           "while [ ! -e killed/.tiles/checkpoint.json ] && kill -0 $pid; do sleep 0.01; done; "
                           "kill -9 $pid; wait $pid";
  EXPECT_NE(std::system((kill + " 2>/dev/null").c_str()), 0);
  ASSERT_TRUE(std::filesystem::exists(folder_ / "killed/.tiles/checkpoint.json"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "killed/map.json"));
  expect_complaint(run(command_ + "killed --resume --cell 0.05"), "--cell \"0\", not \"0.05\"");
  expect_complaint(run(command_ + "killed --resume --rate 5"), "--rate of recording 0 \"0\", not \"5\"");
  write("own.yaml", std::string("name: own\npothole:\n  unit: count\n  depth_mm: [10]\n  severity: [high]\n"));
  expect_complaint(run(command_ + "killed --resume --severity own.yaml"), "content of the severities of recording 0");
  std::filesystem::copy(folder_ / "killed", folder_ / "broken", std::filesystem::copy_options::recursive);
  write("broken/.tiles/frames.jsonl", std::string("{"));
  expect_complaint(run(command_ + "broken --resume"), "is broken");
  const std::string checkpoint = read_text(folder_ / "killed/.tiles/checkpoint.json");
  const auto resume_broken = [&](const std::string& from, const std::string& to) {
    std::filesystem::remove_all(folder_ / "broken");
    std::filesystem::copy(folder_ / "killed", folder_ / "broken", std::filesystem::copy_options::recursive);
    std::string changed = checkpoint;
    const std::size_t at = changed.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    write("broken/.tiles/checkpoint.json", changed.replace(at, from.size(), to));
    return run(command_ + "broken --resume");
  };
  expect_complaint(resume_broken("\"made_with\"", "\"other\""), "this map was started with");
  expect_complaint(resume_broken("\"pass\":0", "\"pass\":-1"), "is broken");
  expect_complaint(resume_broken("\"day_names\":[\"", "\"day_names\":[],\"x\":[\""), "is broken");
  expect_complaint(resume_broken("\"cell_m\":", "\"cell_m\":-"), "cell_m");
  const std::filesystem::path tile =
      *std::filesystem::begin(std::filesystem::directory_iterator(folder_ / "killed/.tiles/0"));
  std::filesystem::remove_all(folder_ / "broken");
  std::filesystem::copy(folder_ / "killed", folder_ / "broken", std::filesystem::copy_options::recursive);
  write("broken/.tiles/0/" + tile.filename().string(), std::string("x"));
  expect_complaint(run(command_ + "broken --resume"), "this tile has 1 bytes");
  std::filesystem::create_directories(folder_ / "killed/.tiles/rasters");
  write("killed/.tiles/rasters/points.las", std::string("half"));  // of a run with --las
  const Outcome resumed = run(command_ + "killed --resume");
  ASSERT_EQ(resumed.exit_code, 0) << resumed.err;
  expect_whole("killed");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "killed/points.las"));
  expect_complaint(run(command_ + "full", "trap '' XFSZ; ulimit -f 1000;"), 1, "cannot be written: File too large");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "full/map.json"));
  ASSERT_EQ(run(command_ + "full --resume").exit_code, 0);
  expect_whole("full");
}

TEST_F(MapCommand, FarPoseIsNamed) {
  const Outcome made = run("synth --scene nadir --frames 3 --flight default --size 160x90 --output flight --quiet");
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const std::string here = "1 0 0 0 0 1 0 0 0 0 1 0\n";
  write("far.txt", here + here + "1 0 0 100000 0 1 0 100000 0 0 1 0\n");
  expect_complaint(map("--trajectory far.txt"), "(limit 8e+09); frame 2 is 141421 m from the middle");
}

// Of the second recording, too, when the first has been mapped.
TEST_F(MapCommand, FarPoseOfLaterRecordingIsNamed) {
  make_flight("160x90");
  const std::string poses = read_text(folder_ / "flight/trajectory_kitti.txt");
  write("far.txt", poses.substr(0, poses.find('\n') + 1) + "1 0 0 100000 0 1 0 100000 0 0 1 0\n");
  expect_complaint(run("map flight flight --calibration flight/calibration.yaml --output map --trajectory "
                       "flight/trajectory_kitti.txt --trajectory far.txt"),
                   "far.txt: its poses and what is mapped lie in a box of ");
}

// Looking at the sky no cell is seen: the other day has its map.
TEST_F(MapCommand, DayWithoutCellsCostsNoOther) {
  make_flight("160x90");
  write("sky.txt", std::string("1 0 0 0 0 -1 0 0 0 0 -1 0\n1 0 0 0 0 -1 0 0 0 0 -1 0\n"));
  const Outcome outcome =
      run("map flight flight --calibration flight/calibration.yaml --output map --day a --day b "
          "--trajectory flight/trajectory_kitti.txt --trajectory sky.txt --quiet");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const nlohmann::json map = json_file("map/map.json");
  EXPECT_NE(map["reasons"].dump().find("the map of b is empty"), std::string::npos) << map["reasons"];
}

TEST_F(MapCommand, NamesNeedNotBeUtf8) {
  make_flight("160x90");
  const std::string name = "fl\xff\xfe";
  std::filesystem::rename(folder_ / "flight", folder_ / name);
  // The second pair cannot be read: its name is in a reason, and the day's in the checkpoint.
  write(name + "/left/000001.png", std::string("no picture"));
  const Outcome outcome = run("map " + name + " --trajectory " + name + "/trajectory_kitti.txt --calibration " + name +
                              "/calibration.yaml --day d\xff --output map --json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(json_file("map/map.json")["mapped"], 1);
}

}  // namespace
}  // namespace roadstereo
