#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "roadstereo/error.hpp"
#include "roadstereo/io/output_folder.hpp"

namespace {

namespace fs = std::filesystem;
using namespace roadstereo;
using namespace roadstereo::io;

class Output : public testing::Test {
 protected:
  Output() {
    std::string name = (fs::temp_directory_path() / "roadstereo-output-XXXXXX").string();
    root = ::mkdtemp(name.data());
  }
  ~Output() override { fs::remove_all(root); }

  fs::path root;
};

std::string text_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::ptrdiff_t entries(const fs::path& folder) {
  return std::distance(fs::directory_iterator(folder), fs::directory_iterator());
}

TEST_F(Output, FilesAppearTogetherAtTheCommit) {
  const fs::path place = root / "a/b";
  {
    OutputFolder folder(place);
    folder.add("one.txt", std::string("first"));
    folder.add("deep/two.bin", std::vector<std::uint8_t>{1, 2, 3});
    folder.add("one.txt", std::string("second"));
    EXPECT_FALSE(fs::exists(place / "one.txt"));
    folder.commit();
    EXPECT_EQ(text_of(place / "one.txt"), "second");
    EXPECT_EQ(text_of(place / "deep/two.bin"), "\1\2\3");
    folder.add("later.txt", std::string("not committed"));
  }
  EXPECT_FALSE(fs::exists(place / "later.txt"));
  EXPECT_EQ(entries(place), 2);
}

TEST_F(Output, LeavesNoTraceWithoutACommit) {
  {
    OutputFolder folder(root / "a/b/");
    folder.add("one.txt", std::string("text"));
  }
  EXPECT_EQ(entries(root), 0);
}

TEST_F(Output, KeepsWhatWasThere) {
  std::ofstream(root / "one.txt") << "old";
  std::ofstream(root / "other.txt") << "other";
  {
    OutputFolder folder(root);
    folder.add("one.txt", std::string("new"));
  }
  EXPECT_EQ(text_of(root / "one.txt"), "old");
  OutputFolder folder(root);
  folder.add("one.txt", std::string("new"));
  folder.commit();
  EXPECT_EQ(text_of(root / "one.txt"), "new");
  EXPECT_EQ(text_of(root / "other.txt"), "other");
}

TEST_F(Output, TakesACommitBackWhenOneFileCannotMove) {
  std::ofstream(root / "a.txt") << "old";
  fs::create_directory(root / "b.txt");
  {
    OutputFolder folder(root);
    folder.add("a.txt", std::string("new"));
    folder.add("c/new.txt", std::string("new"));
    folder.add("b.txt", std::string("new"));
    try {
      folder.commit();
      FAIL() << "a folder stands in the way";
    } catch (const SystemError& error) {
      EXPECT_NE(std::string(error.what()).find((root / "b.txt").string()), std::string::npos) << error.what();
    }
  }
  EXPECT_EQ(text_of(root / "a.txt"), "old");
  EXPECT_EQ(entries(root), 2);
}

TEST_F(Output, SaysWhereItCannotWrite) {
  std::ofstream(root / "file") << "text";
  for (const fs::path& place : {root / "file", root / "file/below", fs::path("/proc/roadstereo")}) {
    try {
      OutputFolder folder(place);
      FAIL() << place;
    } catch (const SystemError& error) {
      FAIL() << "the input is at fault: " << error.what();
    } catch (const Error& error) {
      EXPECT_TRUE(std::string(error.what()).starts_with("cannot write to folder " + place.string() + ": "))
          << error.what();
    }
  }
  EXPECT_THROW(OutputFolder(""), Error);
}

TEST_F(Output, RefusesNamesThatLeaveTheFolder) {
  OutputFolder folder(root);
  for (const char* name : {"", "../up.txt", "a/../../up.txt", "/absolute.txt", "folder/"}) {
    EXPECT_THROW(folder.add(name, std::string("text")), Error) << name;
  }
}

TEST_F(Output, FailedWriteIsTheSystemsFault) {
  OutputFolder folder(root);
  folder.add("name", std::string("text"));
  try {
    folder.add("name/below.txt", std::string("text"));  // a file stands where a folder must be
    FAIL();
  } catch (const SystemError& error) {
    EXPECT_NE(std::string(error.what()).find("below.txt"), std::string::npos) << error.what();
  }
  EXPECT_THROW(folder.add(std::string(300, 'x'), std::string("text")), SystemError);
  folder.commit();
  EXPECT_EQ(entries(root), 2);  // the file, and the staging folder until the end
}

/// Needs a small full file system, which only some machines can give: ROADSTEREO_FULL_DISK names a folder on
/// it.
TEST_F(Output, FullDiskIsTheSystemsFault) {
  const char* full = std::getenv("ROADSTEREO_FULL_DISK");
  if (full == nullptr || !fs::exists(full)) GTEST_SKIP() << "ROADSTEREO_FULL_DISK does not name a folder: not tested";
  const std::ptrdiff_t before = entries(full);
  {
    OutputFolder folder(full);
    const std::string large(static_cast<std::size_t>(fs::space(full).available) + (1U << 20U), 'x');
    EXPECT_THROW(folder.add("large.bin", large), SystemError);
  }
  EXPECT_EQ(entries(full), before);
}

}  // namespace
