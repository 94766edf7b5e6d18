#include "pair_source.hpp"

#include <utility>

#include "roadstereo/error.hpp"
#include "roadstereo/io/calibration_file.hpp"
#include "roadstereo/io/image_file.hpp"
#include "roadstereo/io/rectification.hpp"

namespace roadstereo::cli {

namespace {

void require_equal_sizes(const StereoPair& pair, const PairFiles& files) {
  if (pair.left.width == pair.right.width && pair.left.height == pair.right.height) return;
  fail("left and right image have different sizes: ", files.left, " has ", pair.left.width, "×", pair.left.height,
       " pixels, ", files.right, " has ", pair.right.width, "×", pair.right.height);
}

void rectify_pair(StereoPair& pair, const io::StereoRig& rig) {
  io::RectifiedPair rectified = io::rectify(pair.left, pair.right, rig);
  pair.left = std::move(rectified.left);
  pair.right = std::move(rectified.right);
  pair.calibration = rectified.calibration;
  pair.rectified_here = true;
}

void apply_calibration(StereoPair& pair, const std::vector<std::string>& paths) {
  const io::CalibrationFile file = io::read_calibration(paths[0], paths.size() > 1 ? paths[1] : "");
  pair.calibration_format = file.format;
  pair.calibration = file.rectified;
  if (file.rig) rectify_pair(pair, *file.rig);
  if (!pair.calibration) fail(paths[0], ": there is no stereo calibration in this file");
  pair.calibration->validate(pair.left.width, pair.left.height, paths[0]);
}

bool is_16_bit(const StereoPair& pair) {
  return pair.left.sample == SampleType::u16 && pair.right.sample == SampleType::u16;
}

}  // namespace

StereoPair read_pair(const PairFiles& files) {
  StereoPair pair;
  pair.left = io::read_frame(files.left);
  pair.right = io::read_frame(files.right);
  require_equal_sizes(pair, files);
  if (is_16_bit(pair)) pair.white_level = io::find_white_level(pair.left.view(), pair.right.view());
  if (!files.calibration.empty()) apply_calibration(pair, files.calibration);
  return pair;
}

}  // namespace roadstereo::cli
