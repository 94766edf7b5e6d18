#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>
#include <wordexp.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "apps/roadstereo/command_line.hpp"

namespace roadstereo {

/// How a command ended and what it printed.
struct Outcome {
  int exit_code = -1;
  std::string out;
  std::string err;
};

inline std::string read_text(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  EXPECT_TRUE(file.is_open()) << path;
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The names in a folder.
inline std::set<std::string> names_in(const std::filesystem::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) names.insert(entry.path().filename().string());
  return names;
}

/// A part of the real data, when ROADSTEREO_DATA names a folder that has it.
inline std::optional<std::filesystem::path> data_folder(const std::string& part) {
  const char* folder = std::getenv("ROADSTEREO_DATA");
  if (folder == nullptr || !std::filesystem::is_directory(std::filesystem::path(folder) / part)) return std::nullopt;
  return std::filesystem::path(folder) / part;
}

/// A test that runs the binary in a folder of its own.
class CommandTest : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::temp_directory_path() /
              (std::string("roadstereo_") + test->test_suite_name() + test->name() + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  /// Runs the command line in a process forked from this one; or as the binary, after shell code that prepares its
  /// process or when this process has several threads, of which a forked one would have but one.
  Outcome run(const std::string& arguments, const std::string& before = "") const {
    const std::filesystem::path out = folder_ / "stdout.txt";
    const std::filesystem::path err = folder_ / "stderr.txt";
    const std::string command = "cd '" + folder_.string() + "' && { " + before + " '" ROADSTEREO_BINARY "' " +
                                arguments + " >'" + out.string() + "' 2>'" + err.string() + "'; }";
    const int status =
        before.empty() && threads() == 1 ? run_forked(arguments, out, err) : std::system(command.c_str());
    Outcome outcome{WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_text(out), read_text(err)};
    std::filesystem::remove(out);
    std::filesystem::remove(err);
    return outcome;
  }

  void write(const std::string& name, const std::vector<std::uint8_t>& bytes) const {
    std::ofstream file(folder_ / name, std::ios::binary);
    file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }

  nlohmann::json json_file(const std::string& name) const { return nlohmann::json::parse(read_text(folder_ / name)); }

  std::filesystem::path folder_;

 private:
  /// Number of threads of this process; TBB's stay.
  static std::ptrdiff_t threads() {
    const std::filesystem::directory_iterator tasks("/proc/self/task");
    return std::distance(begin(tasks), end(tasks));
  }

  /// Returns the status of the process, as waitpid does.
  int run_forked(const std::string& arguments, const std::filesystem::path& out,
                 const std::filesystem::path& err) const {
    std::fflush(nullptr);  // or the process would write what is still to be written here
    const pid_t child = ::fork();
    if (child == 0) {
      wordexp_t words{};
      words.we_offs = 1;
      const bool ready = ::chdir(folder_.c_str()) == 0 && std::freopen(out.c_str(), "w", stdout) != nullptr &&
                         std::freopen(err.c_str(), "w", stderr) != nullptr &&
                         ::wordexp(arguments.c_str(), &words, WRDE_DOOFFS) == 0;
      if (!ready) ::_exit(127);
      std::string name = "roadstereo";
      words.we_wordv[0] = name.data();
      std::exit(cli::run_command_line(static_cast<int>(words.we_wordc) + 1, words.we_wordv));
    }
    int status = -1;
    ::waitpid(child, &status, 0);
    return status;
  }
};

/// One sentence on stderr, nothing on stdout.
inline void expect_complaint(const Outcome& outcome, int exit_code, const std::string& part) {
  EXPECT_EQ(outcome.exit_code, exit_code) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(outcome.err.rfind("roadstereo: ", 0), 0U) << outcome.err;
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  EXPECT_NE(outcome.err.find(part), std::string::npos) << "no \"" << part << "\" in: " << outcome.err;
}
inline void expect_complaint(const Outcome& outcome, const std::string& part) {
  expect_complaint(outcome, 2, part);
}

}  // namespace roadstereo
