#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <set>
#include <string>
#include <tuple>

#include "tests/live/memory_source.hpp"

namespace roadstereo::cli {

inline const MemoryFlight& small_flight() {
  static const MemoryFlight flight = fly(320, 180, 3);
  return flight;
}

inline std::unique_ptr<io::FrameSource> source_of(const MemoryPlan& plan) {
  return std::make_unique<MemorySource>(small_flight().frames, plan);
}

inline io::SourcePair frames_pair() {
  io::SourcePair pair;
  std::tie(pair.left, pair.right) = small_flight().frames->front();
  return pair;
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

inline std::string read_text(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  EXPECT_TRUE(file.is_open()) << path;
  return {std::istreambuf_iterator<char>(file), {}};
}

inline std::set<std::string> files_in(const std::filesystem::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) names.insert(std::filesystem::relative(entry.path(), folder).string());
  }
  return names;
}

}  // namespace roadstereo::cli
