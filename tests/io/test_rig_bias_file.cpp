#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "roadstereo/error.hpp"
#include "roadstereo/io/rig_bias_file.hpp"

namespace roadstereo::io {
namespace {

class RigBiasFile : public testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(path_); }

  std::string complaint(const std::string& text) const {
    std::ofstream(path_) << text;
    try {
      read_rig_bias(path_.string());
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }

  static RigBias example() {
    RigBias bias;
    bias.width = 640;
    bias.height = 360;
    bias.focal_px = 1000.0 / 3;
    bias.order = 3;
    bias.frames = 17;
    bias.region_px = {0.25, 100, 639, 359};
    bias.rms_px = 0.1;
    bias.rms_std_error_px = 1.0 / 7;
    for (std::size_t i = 0; i < RigBias::terms; ++i) {
      bias.value_px[i] = 1 / (3.0 + static_cast<double>(i));
      bias.std_error_px[i] = 1 / (300.0 + static_cast<double>(i));
    }
    return bias;
  }

  std::filesystem::path path_ = std::filesystem::temp_directory_path() / ("rig_bias" + std::to_string(std::rand()));
};

TEST_F(RigBiasFile, ReadsWhatWasWritten) {
  const RigBias bias = example();
  ASSERT_EQ(complaint(rig_bias_json(bias)), "");
  const RigBias read = read_rig_bias(path_.string());
  EXPECT_EQ(read.width, 640);
  EXPECT_EQ(read.height, 360);
  EXPECT_EQ(read.focal_px, bias.focal_px);
  EXPECT_EQ(read.order, 3);
  EXPECT_EQ(read.frames, 17);
  EXPECT_EQ(read.region_px, bias.region_px);
  EXPECT_EQ(read.rms_px, bias.rms_px);
  EXPECT_EQ(read.rms_std_error_px, bias.rms_std_error_px);
  EXPECT_EQ(read.value_px, bias.value_px);
  EXPECT_EQ(read.std_error_px, bias.std_error_px);
}

TEST_F(RigBiasFile, NamesFileAndValue) {
  EXPECT_NE(complaint("no json").find(path_.string() + ": this is no rig bias of inspect"), std::string::npos);
  EXPECT_NE(complaint("{\"width\": 640}").find("height"), std::string::npos);
  RigBias bias = example();
  bias.value_px[4] = 1e9;
  EXPECT_NE(complaint(rig_bias_json(bias)).find("rig_bias.value_px is 1000000000"), std::string::npos);
  EXPECT_THROW(read_rig_bias("missing.json"), Error);
}

}  // namespace
}  // namespace roadstereo::io
