// The output folder of `map`: what of other results stays, what goes, and who may write to it.

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "tests/cli/command_test.hpp"

namespace roadstereo {
namespace {

namespace fs = std::filesystem;

class MapFolder : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    const Outcome made =
        run("synth --scene nadir --frames 2 --flight roll=2,pitch=0,climb=0.1,step=0.1 --size 160x90 --output flight "
            "--quiet");
    ASSERT_EQ(made.exit_code, 0) << made.err;
  }
  Outcome map(const std::string& arguments = "") const {
    return run("map flight --trajectory flight/trajectory_kitti.txt --output map --quiet " + arguments);
  }
};

TEST_F(MapFolder, PointsOfEarlierMapAreRemoved) {
  ASSERT_EQ(map("--points --las").exit_code, 0);
  ASSERT_TRUE(fs::exists(folder_ / "map/points.ply"));
  ASSERT_EQ(map("--las").exit_code, 0);
  EXPECT_FALSE(fs::exists(folder_ / "map/points.ply"));
  EXPECT_TRUE(fs::exists(folder_ / "map/points.las"));
  ASSERT_EQ(map().exit_code, 0);
  EXPECT_FALSE(fs::exists(folder_ / "map/points.las"));
}

TEST_F(MapFolder, OtherProcessIsKeptOut) {
  fs::create_directories(folder_ / "map/.tiles");
  write("map/.tiles/of_other", std::string("tile"));
  const int lock = ::open((folder_ / "map/.lock").c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0644);
  ASSERT_EQ(::flock(lock, LOCK_EX), 0);
  expect_complaint(map(), "map: another process is writing to this folder");
  EXPECT_TRUE(fs::exists(folder_ / "map/.tiles/of_other"));
  ::close(lock);
  ASSERT_EQ(map().exit_code, 0);
  EXPECT_FALSE(fs::exists(folder_ / "map/.lock"));
}

TEST_F(MapFolder, IsNotThatOfOtherCommands) {
  ASSERT_EQ(map().exit_code, 0);
  const std::string damages = read_text(folder_ / "map/damages.csv");
  const std::string complaint = "map: this folder has the results of a map; choose another output folder";
  expect_complaint(run("inspect flight --output map --quiet"), complaint);
  expect_complaint(run("inspect flight/left/000000.png flight/right/000000.png --output map --quiet"), complaint);
  ASSERT_EQ(run("inspect flight --write transformed --output run --quiet").exit_code, 0);
  expect_complaint(run("damage run/transformed/000000.tiff --output map --quiet"), complaint);
  EXPECT_EQ(read_text(folder_ / "map/damages.csv"), damages);
}

// Looking up no cell is seen.
TEST_F(MapFolder, EmptyMapLeavesNothing) {
  write("up.txt", std::string("1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0 0 1 0 0 0 0 1 0\n"));
  expect_complaint(run("map flight --crs EPSG:32632 --trajectory up.txt --output map --quiet"), "the map is empty");
  EXPECT_FALSE(fs::exists(folder_ / "map"));
}

// A square of 50 m with the road in two corners: the rasters have 1e8 cells, and writing them takes half a minute.
// A shell keeps Ctrl-C from what it runs in the background: SIGTERM does the same.
TEST_F(MapFolder, CtrlCEndsWritingOfRasters) {
  write("far.txt", std::string("1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 50 0 1 0 50 0 0 1 0\n"));
  const std::string stop =
      "cd '" + folder_.string() +
      "' && { '" ROADSTEREO_BINARY
      "' map flight --trajectory far.txt --cell 0.005 --output map --quiet & } 2>/dev/null; pid=$!; "
      "while [ ! -e map/.tiles/rasters ] && kill -0 $pid; do sleep 0.01; done; "
      "kill -TERM $pid; wait $pid";
  const int status = std::system((stop + " 2>/dev/null").c_str());
  EXPECT_EQ(WEXITSTATUS(status), 130);
  EXPECT_TRUE(fs::exists(folder_ / "map/.tiles/checkpoint.json"));
  EXPECT_FALSE(fs::exists(folder_ / "map/map.json"));
}

/// A run whose poses are on the Earth: cameras that look down, x east.
class MapOfRun : public MapFolder {
 protected:
  void SetUp() override {
    MapFolder::SetUp();
    ASSERT_EQ(run("inspect flight --trajectory --output run --quiet").exit_code, 0);
    write("run/trajectory_kitti.txt",
          std::string("1 0 0 500000 0 -1 0 5300000 0 0 -1 300\n1 0 0 500000 0 -1 0 5300000.1 0 0 -1 300\n"));
    fs::copy(folder_ / "run", folder_ / "other", fs::copy_options::recursive);
    set_crs("run", "EPSG:32632");
  }
  void set_crs(const std::string& name, const std::string& crs) const {
    std::string summary = read_text(folder_ / name / "summary.json");
    const std::string none = "\"crs\": null";
    write(name + "/summary.json", summary.replace(summary.find(none), none.size(), "\"crs\": \"" + crs + "\""));
  }
};

TEST_F(MapOfRun, IsInSystemOfRun) {
  const Outcome outcome = run("map run --output map --quiet");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(json_file("map/map.json")["crs"], "EPSG:32632");
  EXPECT_NEAR(json_file("map/map.json")["west_m"], 500000, 100);
}

TEST_F(MapOfRun, RunsOfOneSystemNeedNoCrs) {
  expect_complaint(
      run("map run other --output map"),
      "the poses of the runs are in different systems: run in EPSG:32632, other in that of its first camera");
  set_crs("other", "EPSG:32632");
  const Outcome outcome = run("map run other --output map --quiet");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(json_file("map/map.json")["crs"], "EPSG:32632");
}

}  // namespace
}  // namespace roadstereo
