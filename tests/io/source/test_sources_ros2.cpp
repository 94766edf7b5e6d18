// Bags of ROS 2 made by other encoders: make_ros2_bags.mjs, whose head says what is in them.
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "io/source/message_log.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/io/frame_source.hpp"
#include "roadstereo/io/track.hpp"

namespace {

namespace fs = std::filesystem;
using namespace roadstereo;
using namespace roadstereo::io;

const fs::path data = ROADSTEREO_BAGS;
constexpr double start_s = 1'700'000'000;

class Ros2Bag : public testing::Test {
 protected:
  Ros2Bag() {
    std::string name = (fs::temp_directory_path() / "roadstereo-ros2-XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
  }
  ~Ros2Bag() override { fs::remove_all(folder_); }

  fs::path folder_;
};

std::string message_of(const std::string& path) {
  try {
    const auto source = open_source({path});
    while (const std::optional<SourcePair> pair = source->next()) {
      if (!pair->error.empty()) return pair->error;
    }
    (void)source->calibration();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

std::vector<char> bytes_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void write(const fs::path& path, const std::vector<char>& bytes) {
  std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

void expect_three_pairs(const std::string& path, const std::string& kind) {
  ASSERT_TRUE(is_recording(path)) << path;
  const auto source = open_source({path});
  EXPECT_EQ(source->size(), 3) << path;
  EXPECT_EQ(source->description(), kind + ", 3 pairs of /stereo/left/image_raw and /stereo/right/image_raw");
  for (std::size_t i = 0; i < 3; ++i) {
    const std::optional<SourcePair> pair = source->next();
    ASSERT_TRUE(pair) << path;
    EXPECT_EQ(pair->error, "");
    EXPECT_NEAR(pair->time_s, start_s + 0.1 * static_cast<double>(i), 1e-6);
    ASSERT_EQ(pair->left.bytes.size(), 48U);  // without the padding
    EXPECT_EQ(pair->left.bytes, std::vector<std::uint8_t>(48, static_cast<std::uint8_t>(10 + i)));
    EXPECT_EQ(pair->right.bytes, std::vector<std::uint8_t>(48, static_cast<std::uint8_t>(110 + i)));
  }
  EXPECT_FALSE(source->next());
  const std::optional<CalibrationFile> calibration = source->calibration();
  ASSERT_TRUE(calibration && calibration->rectified) << path;
  EXPECT_EQ(calibration->rectified->focal_px, 100);
  EXPECT_DOUBLE_EQ(calibration->rectified->baseline_m, 0.12);  // 12 / 100
}

TEST_F(Ros2Bag, EveryContainerHasTheSamePairs) {
  expect_three_pairs(data / "zstd.mcap", "MCAP file");
  expect_three_pairs(data / "unindexed.mcap", "MCAP file");
  expect_three_pairs(data / "rosbag2", "ROS 2 bag");
  expect_three_pairs(data / "rosbag2" / "rosbag2_0.db3", "ROS 2 bag");
  expect_three_pairs(data / "rosbag2_messages", "ROS 2 bag");
  expect_three_pairs(data / "rosbag2_file", "ROS 2 bag");
}

// Writers may leave them out of the summary: they are in the chunks.
TEST_F(Ros2Bag, SummaryNeedNotRepeatChannelsAndSchemas) {
  constexpr std::size_t head = 9, footer = 20, magic = 8;
  constexpr char private_opcode = '\x80';
  const std::vector<char> whole = bytes_of(data / "zstd.mcap");
  const auto number_at = [&whole](std::size_t at) {
    std::uint64_t value = 0;
    std::memcpy(&value, whole.data() + at, sizeof value);
    return static_cast<std::size_t>(value);
  };
  const std::size_t end = whole.size() - magic - footer - head;
  for (const char opcode : {'\3', '\4'}) {  // schema, channel
    std::vector<char> without = whole;
    std::size_t records = 0;
    for (std::size_t at = number_at(end + head); at < end; at += head + number_at(at + 1)) {
      if (without[at] != opcode) continue;
      without[at] = private_opcode;
      ++records;
    }
    ASSERT_GT(records, 0U);
    write(folder_ / "short.mcap", without);
    expect_three_pairs(folder_ / "short.mcap", "MCAP file");
  }
}

TEST_F(Ros2Bag, CompressedImagesInLz4Chunks) {
  const auto source = open_source({data / "lz4.mcap"});
  for (std::size_t i = 0; i < 3; ++i) {
    const SourcePair pair = source->next().value();
    EXPECT_EQ(pair.error, "");
    EXPECT_EQ(pair.left.bytes, std::vector<std::uint8_t>(std::size_t{32} * 32, static_cast<std::uint8_t>(10 + i)));
    EXPECT_EQ(pair.right.bytes.front(), 110 + i);
  }
}

TEST_F(Ros2Bag, RateReplacesTimes) {
  SourceOptions options;
  options.rate_hz = 4;
  const auto source = open_source({data / "lz4.mcap"}, options);
  source->skip(1);
  EXPECT_DOUBLE_EQ(source->next().value().time_s, 0.25);
  EXPECT_DOUBLE_EQ(source->next().value().time_s, 0.5);
}

TEST_F(Ros2Bag, ChunksWithoutSelectedTopicsAreLeftOut) {
  const auto log = open_message_log(data / "zstd.mcap");
  log->select({"/gnss/fix"});
  int fixes = 0;
  while (const auto message = log->next()) {
    EXPECT_EQ(message->topic, "/gnss/fix");
    EXPECT_NEAR(1e-9 * static_cast<double>(message->received_ns), start_s + 0.1 * fixes + 0.004, 1e-6);
    ++fixes;
  }
  EXPECT_EQ(fixes, 3);
}

TEST_F(Ros2Bag, CutFilesEndEarlier) {
  for (const char* name : {"zstd.mcap", "unindexed.mcap"}) {
    const std::vector<char> whole = bytes_of(data / name);
    std::size_t last_pairs = 0;
    for (std::size_t size = 900; size < whole.size(); size += 97) {
      const fs::path cut = folder_ / "cut.mcap";
      write(cut, {whole.begin(), whole.begin() + static_cast<long>(size)});
      std::size_t pairs = 0;
      try {
        const auto source = open_source({cut});
        while (const auto pair = source->next()) pairs += pair->error.empty() ? 1U : 0U;
      } catch (const Error& error) {  // no image so far
        EXPECT_NE(std::string(error.what()).find("image"), std::string::npos) << name << " " << size << error.what();
      }
      EXPECT_GE(pairs, last_pairs) << name << " of " << size << " bytes";
      last_pairs = pairs;
    }
    EXPECT_EQ(last_pairs, 3U) << name;
  }
}

TEST_F(Ros2Bag, DamageIsASentence) {
  std::vector<char> bytes = bytes_of(data / "zstd.mcap");
  for (std::size_t i = 0x100; i < bytes.size(); i += 7) {  // crashes and hangs are what this looks for
    std::vector<char> damaged = bytes;
    damaged[i] = static_cast<char>(damaged[i] ^ 0x55);
    write(folder_ / "damaged.mcap", damaged);
    (void)message_of(folder_ / "damaged.mcap");
  }
  write(folder_ / "text.mcap", {'n', 'o'});
  EXPECT_NE(message_of(folder_ / "text.mcap").find("text.mcap: this is not a bag"), std::string::npos);
  bytes = bytes_of(data / "rosbag2" / "rosbag2_0.db3");
  write(folder_ / "cut.db3", {bytes.begin(), bytes.begin() + 3000});
  EXPECT_NE(message_of(folder_ / "cut.db3").find("cut.db3: the bag cannot be read: database disk image is malformed"),
            std::string::npos)
      << message_of(folder_ / "cut.db3");
  fs::copy(data / "rosbag2", folder_ / "bag", fs::copy_options::recursive);
  fs::remove(folder_ / "bag" / "rosbag2_0.db3");
  EXPECT_NE(message_of(folder_ / "bag").find("rosbag2_0.db3: the file does not exist"), std::string::npos);
  // A bag that lists its own folder.
  bytes = bytes_of(data / "rosbag2" / "metadata.yaml");
  std::string metadata(bytes.begin(), bytes.end());
  metadata.replace(metadata.find("rosbag2_0.db3"), std::strlen("rosbag2_0.db3"), ".");
  write(folder_ / "bag" / "metadata.yaml", {metadata.begin(), metadata.end()});
  EXPECT_NE(message_of(folder_ / "bag").find("is not a regular file"), std::string::npos);
}

/// Where the records of an MCAP file that are chunks begin and end.
std::vector<std::array<std::size_t, 2>> chunks_of(const std::vector<char>& bytes) {
  constexpr std::size_t head = 9, magic = 8;
  constexpr char chunk_opcode = 6;
  std::vector<std::array<std::size_t, 2>> chunks;
  for (std::size_t at = magic; at + head < bytes.size();) {
    std::uint64_t length = 0;
    std::memcpy(&length, bytes.data() + at + 1, sizeof length);
    const std::size_t end = at + head + static_cast<std::size_t>(length);
    if (bytes[at] == chunk_opcode) chunks.push_back({at, end});
    at = end;
  }
  return chunks;
}

// A chunk: opcode, length, two times, then the size of what is compressed.
TEST_F(Ros2Bag, LyingChunkSizeIsRejected) {
  std::vector<char> bytes = bytes_of(data / "zstd.mcap");
  for (const auto& chunk : chunks_of(bytes)) ++bytes[chunk[0] + 9 + 16];
  write(folder_ / "lies.mcap", bytes);
  EXPECT_NE(message_of(folder_ / "lies.mcap").find("its header says"), std::string::npos)
      << message_of(folder_ / "lies.mcap");
}

// One bit of the last chunk: the pairs of the others remain, and one is told to be lost.
TEST_F(Ros2Bag, DamagedChunkCostsItsImagesOnly) {
  constexpr std::size_t before_end = 40;
  std::vector<char> bytes = bytes_of(data / "zstd.mcap");
  const auto chunks = chunks_of(bytes);
  ASSERT_GT(chunks.size(), 1U);
  char& damaged = bytes[chunks.back()[1] - before_end];
  damaged = static_cast<char>(damaged ^ 1);
  write(folder_ / "damaged.mcap", bytes);
  int sound = 0, lost = 0;
  const auto source = open_source({folder_ / "damaged.mcap"});
  while (const std::optional<SourcePair> pair = source->next()) ++(pair->error.empty() ? sound : lost);
  EXPECT_GT(sound, 0);
  EXPECT_GT(lost, 0);
}

// The index of a chunk may leave out which messages the chunk has: opcode 8, four numbers, then a map with its size.
TEST_F(Ros2Bag, ChunkIndexNeedNotListMessages) {
  constexpr std::size_t head = 9, before_map = 4 * 8;
  const std::vector<char> bytes = bytes_of(data / "zstd.mcap");
  std::vector<char> without(bytes.begin(), bytes.begin() + 8);
  std::size_t at = 8, indexes = 0;
  while (at + head < bytes.size()) {
    std::uint64_t length = 0;
    std::memcpy(&length, bytes.data() + at + 1, sizeof length);
    const auto record = bytes.begin() + static_cast<std::ptrdiff_t>(at);
    const std::size_t end = at + head + static_cast<std::size_t>(length);
    without.insert(without.end(), record, bytes.begin() + static_cast<std::ptrdiff_t>(end));
    if (bytes[at] == 8) {
      ++indexes;
      std::uint32_t map_bytes = 0;
      std::memcpy(&map_bytes, bytes.data() + at + head + before_map, sizeof map_bytes);
      const auto copy = without.end() - static_cast<std::ptrdiff_t>(end - at);
      const auto map = copy + static_cast<std::ptrdiff_t>(head + before_map);
      length -= map_bytes;
      std::memcpy(&copy[1], &length, sizeof length);
      std::fill_n(map, sizeof map_bytes, char{0});
      without.erase(map + sizeof map_bytes, map + sizeof map_bytes + map_bytes);
    }
    at = end;
  }
  without.insert(without.end(), bytes.begin() + static_cast<std::ptrdiff_t>(at), bytes.end());
  ASSERT_GT(indexes, 0U);
  write(folder_ / "short.mcap", without);
  expect_three_pairs(folder_ / "short.mcap", "MCAP file");
}

TEST_F(Ros2Bag, FixesAreTrack) {
  for (const char* name : {"zstd.mcap", "rosbag2"}) {
    const Track track = read_track(data / name);
    ASSERT_EQ(track.points().size(), 2U);  // the second has no position
    EXPECT_NEAR(track.points()[1].time_s, start_s + 0.2, 1e-6);
    EXPECT_DOUBLE_EQ(track.points()[1].lat_deg, 48 + 2e-5);
    EXPECT_DOUBLE_EQ(track.points()[1].lon_deg, 11.5);
    EXPECT_DOUBLE_EQ(track.points()[0].alt_m, 520.25);
  }
}

}  // namespace
