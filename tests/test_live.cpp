// Live: what happens to pairs between the source and the view. The parts, then the whole; the page has live_browser.py.
#include <gtest/gtest.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <future>
#include <iterator>
#include <nlohmann/json.hpp>
#include <numeric>
#include <set>
#include <thread>

#include "live/capture.hpp"
#include "live/live_command.hpp"
#include "live/live_session.hpp"
#include "live/newest_slot.hpp"
#include "live/playback.hpp"
#include "live/recorder.hpp"
#include "live/recording_folder.hpp"
#include "live/retry_pause.hpp"
#include "live/terminal_line.hpp"
#include "memory_source.hpp"
#include "roadstereo/io/image_file.hpp"

namespace roadstereo::cli {
namespace {

using namespace std::chrono_literals;
using Seconds = std::chrono::duration<double>;

const MemoryFlight& small_flight() {
  static const MemoryFlight flight = fly(320, 180, 3);
  return flight;
}

std::unique_ptr<io::FrameSource> source_of(const MemoryPlan& plan) {
  return std::make_unique<MemorySource>(small_flight().frames, plan);
}

TEST(NewestSlot, NewestTakesThePlaceOfWhatWaits) {
  NewestSlot<int> slot;
  EXPECT_FALSE(slot.put(1));
  EXPECT_TRUE(slot.put(2));
  EXPECT_TRUE(slot.put(3));
  EXPECT_EQ(slot.take(), 3);
  EXPECT_FALSE(slot.put(4));
  slot.close();
  EXPECT_TRUE(slot.put(5));
  EXPECT_EQ(slot.take(), 4);
  EXPECT_EQ(slot.take(), std::nullopt);
}

TEST(NewestSlot, EveryThingIsFetchedOrLost) {
  constexpr int things = 20000;
  NewestSlot<int> slot;
  int lost = 0, fetched = 0, last = -1;
  std::thread fetching([&] {
    while (const auto thing = slot.take()) {
      EXPECT_GT(*thing, last);
      last = *thing;
      ++fetched;
    }
  });
  for (int i = 0; i < things; ++i) lost += slot.put(i) ? 1 : 0;
  slot.close();
  fetching.join();
  EXPECT_EQ(last, things - 1);
  EXPECT_EQ(fetched + lost, things);
}

io::SourcePair pair_at(std::int64_t index, double time_s = std::nan("")) {
  io::SourcePair pair;
  pair.index = index;
  pair.time_s = time_s;
  return pair;
}

TEST(Playback, PairsComeDueAtTheirTimes) {
  Playback playback(0);
  const Clock::time_point start{};
  EXPECT_EQ(playback.due(pair_at(0, 500), start), start);
  EXPECT_NEAR(seconds_between(start, playback.due(pair_at(1, 500.5), start)), 0.5, 1e-6);
  EXPECT_NEAR(seconds_between(start, playback.due(pair_at(2, 502), start + 9s)), 2, 1e-6) << "due, however late it is";
}

TEST(Playback, RateReplacesTimes) {
  Playback playback(10);
  const Clock::time_point start{};
  EXPECT_EQ(playback.due(pair_at(5, 500), start), start);
  EXPECT_NEAR(seconds_between(start, playback.due(pair_at(8, 777), start)), 0.3, 1e-6);
}

TEST(Playback, OverduePairsAreThoseBeforeTheNewestThatIsDue) {
  Playback playback(10);
  const Clock::time_point start{};
  playback.due(pair_at(0), start);
  EXPECT_EQ(playback.overdue(start + 500ms), 0) << "one pair tells no interval";
  playback.due(pair_at(1), start);  // at 0.1 s; the next ones at 0.2, 0.3, ...
  EXPECT_EQ(playback.overdue(start + 150ms), 0);
  EXPECT_EQ(playback.overdue(start + 250ms), 0) << "the one of 0.2 s is the newest";
  EXPECT_EQ(playback.overdue(start + 350ms), 1);
  EXPECT_EQ(playback.overdue(start + 1050ms), 8);
}

TEST(Playback, AnotherRoundFollowsTheLastPair) {
  Playback playback(0);
  const Clock::time_point start{};
  playback.due(pair_at(0, 100), start);
  playback.due(pair_at(1, 100.25), start);
  playback.begin_again();
  EXPECT_NEAR(seconds_between(start, playback.due(pair_at(0, 100), start)), 0.5, 1e-6);
  EXPECT_NEAR(seconds_between(start, playback.due(pair_at(1, 100.25), start)), 0.75, 1e-6);
}

TEST(Playback, NeedsTimesOrARate) {
  Playback playback(0);
  EXPECT_THROW(playback.due(pair_at(0), Clock::now()), Error);
}

TEST(RetryPause, GrowsToItsLimitAndBeginsAnew) {
  RetryPause pause(0.5, 5);
  for (const double expected : {0.5, 1.0, 2.0, 4.0, 5.0, 5.0}) EXPECT_EQ(pause.next(), expected);
  pause.reset();
  EXPECT_EQ(pause.next(), 0.5);
}

TEST(LatencyLog, QuantilesAreRanks) {
  LatencyLog log;
  for (int i = 100; i >= 1; --i) log.add(i);
  for (const LatencyFigures& figures : {log.recent(), log.all()}) {
    EXPECT_EQ(figures.median_ms, 50);
    EXPECT_EQ(figures.p95_ms, 95);
    EXPECT_EQ(figures.max_ms, 100);
  }
}

TEST(LatencyLog, RecentForgetsAllDoesNot) {
  LatencyLog log;
  for (int i = 0; i < 1000; ++i) log.add(9000);
  for (int i = 0; i < 150; ++i) log.add(20.1);
  EXPECT_EQ(log.recent().max_ms, 20.1);
  EXPECT_EQ(log.all().max_ms, 9000);
  EXPECT_EQ(log.all().median_ms, 9000) << "beyond the bins";
  for (int i = 0; i < 2000; ++i) log.add(20.1);
  EXPECT_EQ(log.all().median_ms, 20.25) << "to a quarter of a millisecond, from above";
}

TEST(RateMeter, CountsGapsAlsoTheOpenOne) {
  RateMeter meter;
  const Clock::time_point start{};
  for (int i = 0; i <= 100; ++i) meter.add(start + i * 40ms);
  EXPECT_NEAR(meter.per_second(start + 4s), 25, 1e-6);
  EXPECT_NEAR(meter.per_second(start + 5s), 25.0 / (1 + 0.96), 0.6);
  EXPECT_EQ(meter.per_second(start + 7s), 0);
}

LiveView view_of(double age_s) {
  LiveView view;
  view.arrival = Clock::now() - clock_span(age_s);
  return view;
}

TEST(LiveBoard, StateFollowsTheAgeOfWhatIsShown) {
  LiveBoard board(1000);
  EXPECT_EQ(board.status().state, LiveState::starting);
  board.publish(view_of(2000));
  EXPECT_EQ(board.status().state, LiveState::stale);
  EXPECT_GE(board.status().age_s, 2000);
  board.publish(view_of(1));
  EXPECT_EQ(board.status().state, LiveState::live);
  board.lose_camera("gone");
  EXPECT_EQ(board.status().state, LiveState::reconnecting);
  EXPECT_EQ(board.status().message, "gone");
  board.camera_is_back();
  EXPECT_EQ(board.status().state, LiveState::live);
  EXPECT_EQ(board.status().message, "");
  EXPECT_EQ(board.status().counts.reconnects, 1);
  board.end();
  EXPECT_EQ(board.status().state, LiveState::ended);
}

TEST(LiveBoard, LatencyCountsFromArrivalToPublication) {
  LiveBoard board(1000);
  for (const double age : {0.3, 0.2, 0.1}) board.publish(view_of(age));
  const LiveStatus status = board.status();
  EXPECT_GE(status.view->latency_ms, 100);
  EXPECT_GE(status.latency.median_ms, 200);
  EXPECT_GE(status.latency.p95_ms, 300);
  EXPECT_EQ(status.latency.max_ms, board.latency_of_all().max_ms);
  EXPECT_GE(1000 * status.age_s, status.view->latency_ms) << "what is shown is never younger than it was at first";
}

TEST(LiveBoard, NewsWakesWhoWaits) {
  LiveBoard board(1000);
  auto waiting = std::async(std::launch::async, [&board] { return board.wait_for_news(0, 60); });
  board.publish(view_of(0));
  EXPECT_EQ(waiting.get().view->number, 1);
  EXPECT_EQ(board.wait_for_news(0, 60).view->number, 1) << "what is there already is not waited for";
  EXPECT_EQ(board.wait_for_news(1, 0.01).view->number, 1) << "time is up";
  waiting = std::async(std::launch::async, [&board] { return board.wait_for_news(1, 60); });
  board.end();
  EXPECT_EQ(waiting.get().state, LiveState::ended);
}

TEST(LiveBoard, KeepsTheLatestViews) {
  LiveBoard board(1000);
  EXPECT_EQ(board.view(0), nullptr);
  for (int i = 0; i < 9; ++i) board.publish(view_of(0));
  EXPECT_EQ(board.view(8)->number, 8);
  EXPECT_EQ(board.view(2)->number, 9) << "gone: the newest";
}

Damage damage_at(double u, double v, DamageKind kind, double depth_error) {
  Damage damage;
  damage.kind = kind;
  damage.centroid_px = {u, v};
  damage.box_px = {static_cast<int>(u) - 10, static_cast<int>(v) - 10, static_cast<int>(u) + 10,
                   static_cast<int>(v) + 10};
  damage.max_depth_px = {2, depth_error};
  return damage;
}

LiveView view_at(std::int64_t number, double seconds, std::vector<Damage> damages) {
  LiveView view;
  view.number = number;
  view.arrival = Clock::time_point{} + clock_span(100 + seconds);
  view.damages = std::move(damages);
  return view;
}

TEST(DamageList, OneThatMovesIsOne) {
  DamageList list;
  for (int i = 0; i < 20; ++i) {  // 13 px a picture, slower at first, with gaps; a bump goes with it
    if (i % 5 == 4) continue;
    const double v = i * (i < 3 ? 8 : 13) - (i < 3 ? 0 : 10);
    list.add(view_at(
        i + 1, i / 30.0,
        {damage_at(100, v, DamageKind::depression, 0.5 - 0.01 * i), damage_at(104, v, DamageKind::protrusion, 0.3)}));
  }
  EXPECT_EQ(list.found(), 2);
  ASSERT_EQ(list.entries().size(), 2U);
  const ListedDamage& bump = list.entries()[0];
  const ListedDamage& hole = list.entries()[1];
  EXPECT_EQ(hole.best.kind, DamageKind::depression);
  EXPECT_EQ(hole.views, 16);
  EXPECT_EQ(hole.changed_in, 19) << "the last view knew it best";
  EXPECT_DOUBLE_EQ(hole.best.max_depth_px.std_error, 0.5 - 0.01 * 18);
  EXPECT_EQ(bump.changed_in, 1) << "no view knew it better than the first";
}

TEST(DamageList, WholeIsBetterThanCut) {
  DamageList list;
  Damage cut = damage_at(50, 10, DamageKind::depression, 0.01);
  cut.cut_by_border = true;
  list.add(view_at(1, 0, {cut}));
  list.add(view_at(2, 0.03, {damage_at(50, 15, DamageKind::depression, 0.4)}));
  list.add(view_at(3, 0.06, {cut}));
  ASSERT_EQ(list.found(), 1);
  EXPECT_FALSE(list.entries()[0].best.cut_by_border);
  EXPECT_EQ(list.entries()[0].changed_in, 2);
}

TEST(DamageList, AnotherPlaceOrLaterIsAnotherOne) {
  DamageList list;
  list.add(view_at(1, 0, {damage_at(50, 50, DamageKind::depression, 0.1)}));
  list.add(view_at(2, 0.03, {damage_at(200, 50, DamageKind::depression, 0.1)}));
  EXPECT_EQ(list.found(), 2);
  list.add(view_at(3, 5, {damage_at(50, 50, DamageKind::depression, 0.1)}));
  EXPECT_EQ(list.found(), 3);
  EXPECT_EQ(list.entries()[0].id, 3) << "newest first";
}

TEST(DamageList, KeepsTheLatestHundred) {
  DamageList list;
  for (int i = 0; i < 130; ++i) list.add(view_at(i + 1, 2.0 * i, {damage_at(50, 50, DamageKind::depression, 0.1)}));
  EXPECT_EQ(list.found(), 130);
  EXPECT_EQ(list.entries().size(), 100U);
  EXPECT_EQ(list.entries().front().id, 130);
  EXPECT_EQ(list.entries().back().id, 31);
}

/// A capture without those who fetch from its slot.
struct CaptureBench {
  LiveBoard board{1000};
  NewestSlot<CapturedPair> slot;
  std::stop_source stop;

  void run(const SourceOpener& opener, CaptureOptions options = {}) {
    Capture capture(opener(), opener, options, board, slot, nullptr);
    capture.run(stop.get_token());
  }
};

TEST(Capture, PairsThatNobodyFetchesAreDropped) {
  CaptureBench bench;
  bench.run([] { return source_of({40, 0.001, false, "", 7}); });
  const LiveCounts counts = bench.board.status().counts;
  EXPECT_EQ(counts.taken, 40);
  EXPECT_EQ(counts.refused, counts.taken - counts.dropped - 1) << "one waits in the slot";
  EXPECT_LE(counts.refused, 1) << "it may have been passed over";
  bench.slot.close();
  const auto newest = bench.slot.take();
  ASSERT_TRUE(newest);
  EXPECT_EQ(newest->pair.index, 39);
}

TEST(Capture, LateSourcePassesOverPairs) {
  CaptureBench bench;
  CaptureOptions options;
  options.rate_hz = 10000;  // no memory is as fast
  bench.run([] { return source_of({3000, 0, false, "", -1}); }, options);
  const LiveCounts counts = bench.board.status().counts;
  EXPECT_EQ(counts.taken, 3000);
  EXPECT_EQ(counts.dropped, 2999);
  bench.slot.close();
  const auto newest = bench.slot.take();
  ASSERT_TRUE(newest);
  EXPECT_EQ(newest->pair.index, 2999) << "the last one is shown";
}

TEST(Capture, LostCameraIsRetriedUntilItIsBack) {
  CaptureBench bench;
  CaptureOptions options;
  options.pause = RetryPause(0.001, 0.002);
  int openings = 0;
  bench.run(
      [&]() -> std::unique_ptr<io::FrameSource> {
        ++openings;
        if (openings > 1) {
          EXPECT_EQ(bench.board.status().state, LiveState::reconnecting);
        }
        if (openings == 2) {
          EXPECT_EQ(bench.board.status().message, "unplugged");
        }
        if (openings == 3) throw Error("still unplugged");
        if (openings == 4) {
          EXPECT_EQ(bench.board.status().message, "still unplugged");
        }
        if (openings == 6) bench.stop.request_stop();
        if (openings == 2) return source_of({0, 0, true, "opened, but gives nothing", -1});
        return source_of({2, 0, true, openings == 1 ? "unplugged" : "", -1});
      },
      options);
  const LiveCounts counts = bench.board.status().counts;
  EXPECT_EQ(openings, 6);
  EXPECT_EQ(counts.reconnects, 2) << "with the openings 4 and 5: only a picture tells that it is back";
  EXPECT_EQ(counts.taken, 6);
}

TEST(Capture, RecordingThatFailsEndsTheRun) {
  CaptureBench bench;
  EXPECT_THROW(bench.run([] { return source_of({2, 0.001, false, "the disk is gone", -1}); }), Error);
  EXPECT_THROW(bench.run(
                   [] {
                     return source_of({0, 0.001, false, "", -1});
                   },
                   {0, true, {}}),
               Error)
      << "nothing to loop over";
}

TEST(Capture, LoopBeginsAgain) {
  CaptureBench bench;
  int openings = 0;
  bench.run(
      [&] {
        if (++openings == 4) bench.stop.request_stop();
        return source_of({3, 0.001, false, "", -1});
      },
      {0, true, {}});
  EXPECT_EQ(bench.board.status().counts.taken, 9);
}

io::SourcePair frames_pair() {
  io::SourcePair pair;
  std::tie(pair.left, pair.right) = small_flight().frames->front();
  return pair;
}

TEST(Recorder, BlockedDiskKeepsNobodyWaiting) {
  LiveBoard board(1000);
  std::promise<void> begun, freed;
  std::atomic<int> written = 0;
  {
    Recorder recorder(
        [&](const RecordedPair& pair) {
          if (written++ == 0) begun.set_value();
          if (pair.time_s == 0) freed.get_future().wait();
        },
        board);
    recorder.offer(frames_pair(), 0);
    begun.get_future().wait();
    const int most = static_cast<int>(Recorder::most_waiting);
    for (int i = 1; i <= most + 5; ++i) recorder.offer(frames_pair(), i);  // would hang if it waited
    EXPECT_EQ(board.status().recording.left_out, 5);
    EXPECT_EQ(board.status().recording.recorded, 0);
    freed.set_value();
  }
  EXPECT_EQ(board.status().recording.recorded, 1 + static_cast<int>(Recorder::most_waiting)) << "the rest is written";
  EXPECT_EQ(board.status().recording.message, "");
}

TEST(Recorder, FullDiskStopsItWithAMessage) {
  LiveBoard board(1000);
  std::atomic<int> tried = 0;
  {
    Recorder recorder(
        [&](const RecordedPair& pair) {
          ++tried;
          if (pair.time_s > 0) throw SystemError("no space left");
        },
        board);
    recorder.offer(frames_pair(), 0);
    recorder.offer(frames_pair(), 1);
    while (board.status().recording.message.empty()) std::this_thread::yield();
    recorder.offer(frames_pair(), 2);
  }
  const RecordingState state = board.status().recording;
  EXPECT_EQ(tried, 2);
  EXPECT_EQ(state.recorded, 1);
  EXPECT_EQ(state.left_out, 2);
  EXPECT_EQ(state.message, "recording has stopped: no space left");
}

/// A test with a folder of its own.
class LiveFiles : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::temp_directory_path() /
              (std::string("roadstereo_live_") + test->name() + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }

  std::filesystem::path folder_;
};

std::string read_text(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::set<std::string> files_in(const std::filesystem::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) names.insert(std::filesystem::relative(entry.path(), folder).string());
  }
  return names;
}

/// Samples of every value that a camera of 16 bits may give.
Frame deep_frame() {
  Frame frame{std::vector<std::uint8_t>(2 * 64 * 48), 64, 48, SampleType::u16, ChannelOrder::grey};
  std::iota(frame.bytes.begin(), frame.bytes.end(), static_cast<std::uint8_t>(0));
  return frame;
}

TEST_F(LiveFiles, RecordingKeepsEverySample) {
  write("cal.yaml", "focal_px: 1\n");
  const io::SourcePair pair = frames_pair();
  {
    RecordingFolder folder(folder_ / "rec", {(folder_ / "cal.yaml").string()});
    folder.write({pair.left, pair.right, 1700000000.25});
    folder.write({deep_frame(), deep_frame(), 1700000000.5});
  }
  EXPECT_EQ(files_in(folder_ / "rec"),
            (std::set<std::string>{"cal.yaml", "times.txt", "left/000000.png", "left/000001.png", "right/000000.png",
                                   "right/000001.png"}));
  EXPECT_EQ(read_text(folder_ / "rec/times.txt"), "1700000000.250000\n1700000000.500000\n");
  EXPECT_EQ(read_text(folder_ / "rec/cal.yaml"), "focal_px: 1\n");
  EXPECT_EQ(io::read_frame((folder_ / "rec/left/000000.png").string()).bytes, pair.left.bytes);
  EXPECT_EQ(io::read_frame((folder_ / "rec/right/000000.png").string()).bytes, pair.right.bytes);
  EXPECT_EQ(io::read_frame((folder_ / "rec/left/000001.png").string()).bytes, deep_frame().bytes);
}

TEST_F(LiveFiles, PairThatCannotBeWrittenLeavesNothing) {
  RecordingFolder folder(folder_ / "rec", {});
  folder.write({deep_frame(), deep_frame(), 1});
  std::filesystem::remove_all(folder_ / "rec/right");
  write("rec/right", "in the way");
  EXPECT_THROW(folder.write({deep_frame(), deep_frame(), 2}), SystemError);
  EXPECT_EQ(files_in(folder_ / "rec"), (std::set<std::string>{"left/000000.png", "right", "times.txt"}));
  EXPECT_EQ(read_text(folder_ / "rec/times.txt"), "1.000000\n");
}

TEST_F(LiveFiles, RecordingIsNotWrittenOver) {
  RecordingFolder(folder_ / "rec", {});
  EXPECT_TRUE(files_in(folder_ / "rec").empty()) << "without a pair nothing stays";
  {
    RecordingFolder folder(folder_ / "rec", {});
    folder.write({deep_frame(), deep_frame(), 1});
  }
  EXPECT_THROW(RecordingFolder(folder_ / "rec", {}), Error);
}

TEST_F(LiveFiles, EqualNamesOfCalibrationsAreToldApart) {
  for (const char* side : {"a", "b"}) {
    std::filesystem::create_directories(folder_ / side);
    write(std::string(side) + "/info.yaml", side);
  }
  const RecordingFolder folder(folder_ / "rec",
                               {(folder_ / "a/info.yaml").string(), (folder_ / "b/info.yaml").string()});
  EXPECT_EQ(read_text(folder_ / "rec/left_info.yaml"), "a");
  EXPECT_EQ(read_text(folder_ / "rec/right_info.yaml"), "b");
}

/// A session to its end.
LiveStatus run_session(const LiveOptions& options, const MemoryPlan& plan) {
  LiveSession session(options, [&plan] { return source_of(plan); });
  session.start();
  while (!session.finished()) std::this_thread::sleep_for(1ms);
  session.end();
  return session.board().status();
}

TEST(LiveSession, EveryPairIsAccountedFor) {
  LiveOptions options;
  options.max_age_s = 1000;
  const LiveStatus status = run_session(options, {12, 0.01, false, "", 11});
  const LiveCounts& counts = status.counts;
  EXPECT_EQ(counts.taken, 12);
  EXPECT_EQ(counts.taken, counts.shown + counts.dropped + counts.too_old + counts.refused);
  EXPECT_EQ(counts.refused, 1);
  EXPECT_GE(counts.shown, 1);
  ASSERT_TRUE(status.view);
  EXPECT_EQ(status.view->left.width, 320);
  EXPECT_EQ(status.view->transformed.width(), 320);
  EXPECT_EQ(status.view->ids.height(), 180);
  EXPECT_EQ(status.view->number, counts.shown);
}

TEST(LiveSession, OldPairsAreNotProcessed) {
  LiveOptions options;
  options.max_age_s = 1e-9;
  const LiveCounts counts = run_session(options, {5, 0.001, false, "", -1}).counts;
  EXPECT_EQ(counts.shown, 0);
  EXPECT_GE(counts.too_old, 1);
  EXPECT_EQ(counts.taken, counts.too_old + counts.dropped);
}

TEST(LiveSession, PairThatTheMatcherRefusesIsCounted) {
  LiveOptions options;
  auto frames = std::make_shared<std::vector<PairOfFrames>>(*small_flight().frames);
  for (PairOfFrames& pair : *frames) pair.second = pair.first;
  LiveSession session(options, [&frames] {
    return std::make_unique<MemorySource>(frames, MemoryPlan{2, 0.5, false, "", -1});
  });
  session.start();
  while (!session.finished()) std::this_thread::sleep_for(1ms);
  EXPECT_NE(session.board().wait_for_news(0, 0.01).message.find("same image"), std::string::npos);
  session.end();
  EXPECT_EQ(session.board().status().counts.refused, 2);
}

TEST_F(LiveFiles, SessionThatDoesNotStartLeavesNoRecording) {
  LiveOptions options;
  options.record = (folder_ / "rec").string();
  {
    const LiveSession session(options, [] { return source_of({1, 0.001, false, "", -1}); });
  }
  EXPECT_TRUE(files_in(folder_).empty());
}

TEST(LiveSession, FirstOpeningMustSucceed) {
  EXPECT_THROW(LiveSession({}, []() -> std::unique_ptr<io::FrameSource> { throw Error("no such camera"); }), Error);
}

TEST(LiveSession, FailureOfTheSourceIsThrownAtTheEnd) {
  LiveSession session({}, [] { return source_of({1, 0.001, false, "the disk is gone", -1}); });
  session.start();
  while (!session.finished()) std::this_thread::sleep_for(1ms);
  EXPECT_THROW(session.end(), Error);
  EXPECT_EQ(session.board().status().message, "the disk is gone");
}

/// `live` in this process.
nlohmann::json live_json(const std::string& arguments, const MemoryPlan& plan) {
  CLI::App app;
  add_live_command(app, [&plan](const std::vector<std::string>&, const io::SourceOptions&) { return source_of(plan); });
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  app.parse("live memory --json " + arguments);
  testing::internal::GetCapturedStderr();
  return nlohmann::json::parse(testing::internal::GetCapturedStdout());
}

TEST_F(LiveFiles, SummaryAndRecording) {
  const nlohmann::json summary =
      live_json("--max-age 60000 --record " + (folder_ / "rec").string(), {6, 0.02, false, "", -1});
  EXPECT_EQ(summary["taken"], 6);
  EXPECT_EQ(summary["processed"].get<int>() + summary["dropped"].get<int>(), 6);
  EXPECT_GT(summary["latency_ms"]["median"], 0);
  EXPECT_GT(summary["peak_memory_mib"], 1);
  const int recorded = summary["recorded"].get<int>();
  ASSERT_GE(recorded, 1);
  EXPECT_EQ(files_in(folder_ / "rec").size(), 1U + 2 * static_cast<std::size_t>(recorded));
  const std::string times = read_text(folder_ / "rec/times.txt");
  EXPECT_EQ(std::count(times.begin(), times.end(), '\n'), recorded);
  EXPECT_EQ(times.substr(0, 12), "1000.000000\n");
}

TEST_F(LiveFiles, EndsByItself) {
  EXPECT_GE(live_json("--frames 1 --max-age 60000", {100000, 0.02, false, "", -1})["processed"], 1);
  EXPECT_GE(live_json("--seconds 0.1 --loop", {2, 0.02, false, "", -1})["taken"], 3);
}

TEST(TerminalLine, SaysHowThingsStand) {
  LiveStatus status;
  EXPECT_EQ(status_line(status), "starting for 0.0 s");
  auto view = std::make_shared<LiveView>();
  view->geometry.emplace();
  view->geometry->roll_rad = 0.1;
  view->geometry->roll_observable = true;
  view->damages.resize(2);
  status.view = view;
  status.state = LiveState::stale;
  status.age_s = 1.5;
  status.fps = 29.96;
  status.latency = {40.4, 61.2, 99};
  status.damages_found = 7;
  status.counts.dropped = 3;
  status.recording = {true, 5, 1, ""};
  EXPECT_EQ(
      status_line(status),
      "stale 30.0 fps, latency 40/61 ms, age 1500 ms, roll 5.73°, damages 2/7, dropped 3, recorded 5 (1 left out)");
}

}  // namespace
}  // namespace roadstereo::cli
