#include <gtest/gtest.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <thread>

#include "roadstereo/error.hpp"
#include "roadstereo/io/output_folder.hpp"

namespace {

namespace fs = std::filesystem;
using namespace roadstereo;
using namespace roadstereo::io;

class OutputFolderFiles : public testing::Test {
 protected:
  OutputFolderFiles() {
    std::string name = (fs::temp_directory_path() / "roadstereo-output-XXXXXX").string();
    root = ::mkdtemp(name.data());
  }
  ~OutputFolderFiles() override { fs::remove_all(root); }

  fs::path root;
};

std::string text_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::ptrdiff_t entries(const fs::path& folder) {
  return std::distance(fs::directory_iterator(folder), fs::directory_iterator());
}

TEST_F(OutputFolderFiles, AppearTogetherAtCommit) {
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

TEST_F(OutputFolderFiles, VanishWithoutCommit) {
  {
    OutputFolder folder(root / "a/b/");
    folder.add("one.txt", std::string("text"));
  }
  EXPECT_EQ(entries(root), 0);
}

TEST_F(OutputFolderFiles, KeepOtherFiles) {
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

TEST_F(OutputFolderFiles, RemovesWhatEarlierResultHasLeft) {
  for (const char* name : {"cloud.ply", "sigma.tiff"}) std::ofstream(root / name) << "of another pair";
  OutputFolder folder(root);
  folder.protect(root / "sigma.tiff");
  folder.add("result.json", std::string("new"));
  for (const char* name : {"cloud.ply", "sigma.tiff", "none.ply"}) folder.remove(name);
  EXPECT_TRUE(fs::exists(root / "cloud.ply"));
  folder.commit();
  EXPECT_FALSE(fs::exists(root / "cloud.ply"));
  EXPECT_EQ(text_of(root / "sigma.tiff"), "of another pair");
  EXPECT_EQ(text_of(root / "result.json"), "new");
}

TEST_F(OutputFolderFiles, FailedCommitIsRolledBack) {
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

TEST_F(OutputFolderFiles, KilledProcessLeavesWhatNextOneRemoves) {
  const pid_t child = ::fork();
  if (child == 0) {
    OutputFolder folder(root);
    folder.add("one.txt", std::string("text"));
    ::raise(SIGKILL);
  }
  ::waitpid(child, nullptr, 0);
  EXPECT_EQ(entries(root), 1);
  OutputFolder running(root);
  EXPECT_EQ(entries(root), 0);
  running.add("one.txt", std::string("text"));
  { OutputFolder other(root); }
  running.commit();
  EXPECT_EQ(text_of(root / "one.txt"), "text") << "that of a running process stays";
}

TEST_F(OutputFolderFiles, ReplacedFileIsNeverMissing) {
  std::ofstream(root / "one.txt") << "old";
  std::atomic<bool> done = false;
  std::atomic<int> missing = 0;
  std::thread watcher([&] {
    while (!done) missing += fs::exists(root / "one.txt") ? 0 : 1;
  });
  for (int i = 0; i < 300; ++i) {
    OutputFolder folder(root);
    folder.add("one.txt", std::to_string(i));
    folder.commit();
  }
  done = true;
  watcher.join();
  EXPECT_EQ(missing, 0);
  EXPECT_EQ(text_of(root / "one.txt"), "299");
}

TEST_F(OutputFolderFiles, InputIsNotOverwritten) {
  std::ofstream(root / "left.png") << "input";
  OutputFolder folder(root);
  folder.protect(root / "." / "left.png");
  folder.protect("no such file");
  folder.add("other.png", std::string("new"));
  EXPECT_THROW(folder.add("left.png", std::string("new")), Error);
  folder.commit();
  EXPECT_EQ(text_of(root / "left.png"), "input");
}

TEST_F(OutputFolderFiles, ErrorNamesUnwritableFolder) {
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

TEST_F(OutputFolderFiles, RejectNamesOutsideFolder) {
  OutputFolder folder(root);
  for (const char* name : {"", "../up.txt", "a/../../up.txt", "/absolute.txt", "folder/"}) {
    EXPECT_THROW(folder.add(name, std::string("text")), Error) << name;
  }
}

TEST_F(OutputFolderFiles, FailedWriteIsSystemError) {
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
  EXPECT_EQ(entries(root), 1);
}

/// A limit on the size of files, which makes writes fail as a full disk does, as long as this lives.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) {
    ::signal(SIGXFSZ, SIG_IGN);
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    ::signal(SIGXFSZ, SIG_DFL);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  rlimit before_{};
};

TEST_F(OutputFolderFiles, FullDiskIsSystemError) {
  const std::ptrdiff_t before = entries(root);
  {
    OutputFolder folder(root);
    const FileSizeLimit limit(1U << 20U);
    EXPECT_THROW(folder.add("large.bin", std::string((1U << 20U) + 1, 'x')), SystemError);
  }
  EXPECT_EQ(entries(root), before);
}

}  // namespace
