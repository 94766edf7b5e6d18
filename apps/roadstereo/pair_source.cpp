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

io::RectifiedPair rectified_pair(const StereoPair& pair, const io::StereoRig& rig, const std::string& source,
                                 int threads) {
  try {
    return io::rectify(pair.left, pair.right, rig, threads);
  } catch (const SystemError&) {
    throw;
  } catch (const Error& error) {
    fail(source, ": ", error.what());
  }
}

void rectify_pair(StereoPair& pair, const io::StereoRig& rig, const std::string& source, int threads) {
  io::RectifiedPair rectified = rectified_pair(pair, rig, source, threads);
  pair.left = std::move(rectified.left);
  pair.right = std::move(rectified.right);
  pair.calibration = rectified.calibration;
  pair.rectified_here = true;
}

void read_disparity_map(const std::string& path, StereoPair& pair) {
  pair.disparity = io::read_disparity(path);
  if (pair.disparity.width() == pair.left.width && pair.disparity.height() == pair.left.height) return;
  fail(path, " has ", pair.disparity.width(), "×", pair.disparity.height(), " pixels; it must have ", pair.left.width,
       "×", pair.left.height, " like the left image");
}

void apply_calibration(StereoPair& pair, const std::vector<std::string>& paths, int threads) {
  io::CalibrationFile file = io::read_calibration(paths[0], paths.size() > 1 ? paths[1] : "");
  file.select_size(pair.left.width, pair.left.height, paths[0]);
  pair.calibration_format = file.format;
  pair.calibration = file.rectified;
  if (file.rig && !pair.disparity.empty()) {
    fail(paths[0], ": the rig is not rectified; a disparity map needs the calibration of the rectified pair");
  }
  if (const std::string doubt = file.size_doubt(pair.left.width, pair.left.height); !doubt.empty()) {
    pair.warnings.push_back("calibration-size: " + paths[0] + ": " + doubt);
  }
  if (file.rig) rectify_pair(pair, *file.rig, paths[0], threads);
  if (!pair.calibration) fail(paths[0], ": there is no stereo calibration in this file");
  pair.calibration->validate(pair.left.width, pair.left.height, paths[0]);
}

/// White level of 16-bit images; 0 for others.
double white_level_of(const StereoPair& pair) {
  const Frame& other = pair.right.bytes.empty() ? pair.left : pair.right;
  const bool wide = pair.left.sample == SampleType::u16 && other.sample == SampleType::u16;
  return wide ? io::find_white_level(pair.left.view(), other.view()) : 0;
}

}  // namespace

StereoPair read_pair(const PairFiles& files, int threads) {
  StereoPair pair;
  pair.left = io::read_frame(files.left);
  if (!files.right.empty()) {
    pair.right = io::read_frame(files.right);
    require_equal_sizes(pair, files);
  }
  if (!files.disparity.empty()) read_disparity_map(files.disparity, pair);
  pair.white_level = white_level_of(pair);
  if (!files.calibration.empty()) apply_calibration(pair, files.calibration, threads);
  return pair;
}

}  // namespace roadstereo::cli
