#pragma once

#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "roadstereo/error.hpp"
#include "roadstereo/io/calibration_file.hpp"

namespace roadstereo::io {

/// A test that writes calibrations to a folder of its own.
class CalibrationTest : public testing::Test {
 protected:
  CalibrationTest() {
    std::string name = (std::filesystem::temp_directory_path() / "roadstereo-calibration-XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
  }
  ~CalibrationTest() override { std::filesystem::remove_all(folder_); }

  std::string write(const std::string& text, const std::string& name = "calibration") const {
    const std::filesystem::path path = folder_ / name;
    std::ofstream(path, std::ios::binary) << text;
    return path.string();
  }
  StereoCalibration rectified(const std::string& text) const { return read_calibration(write(text)).rectified.value(); }

  /// Expects one sentence that names the file and says `part`.
  void expect_refused(const std::string& text, const std::string& part) const {
    expect_refused_file(write(text), part);
  }
  static void expect_refused_file(const std::string& path, const std::string& part, const std::string& second = "") {
    testing::internal::CaptureStderr();
    std::string message = "no error";
    try {
      read_calibration(path, second);
    } catch (const Error& error) {
      message = error.what();
    }
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    EXPECT_NE(message.find(second.empty() ? path : std::filesystem::path(path).parent_path().string()),
              std::string::npos)
        << message;
    EXPECT_NE(message.find(part), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }

 private:
  std::filesystem::path folder_;
};

inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

}  // namespace roadstereo::io
