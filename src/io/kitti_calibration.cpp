#include <cmath>

#include "io/calibration_formats.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

using Projection = std::array<double, 12>;

/// Keys of one pair of cameras.
struct PairNames {
  std::string left;
  std::string right;
  std::string size;
};

Projection read_projection(const CalibrationText& file, const std::vector<KeyLine>& lines, const std::string& key) {
  const KeyLine* line = find_key(lines, key);
  if (line == nullptr) fail(file.path, ": ", key, " is missing");
  const std::vector<std::string_view> words = split_words(line->value);
  Projection p{};
  if (words.size() != p.size()) fail(file.path, ": ", key, " has ", words.size(), " values; it must have 12");
  for (std::size_t i = 0; i < p.size(); ++i) {
    p[i] = parse_number(file.path, key + "[" + std::to_string(i) + "]", words[i]);
  }
  return p;
}

/// Prefers the colour pair to the grey one; an incomplete pair is named in the error.
PairNames choose_pair(const std::vector<KeyLine>& lines) {
  const std::array<PairNames, 4> pairs{{{"P2", "P3", "S_rect_02"},
                                        {"P_rect_02", "P_rect_03", "S_rect_02"},
                                        {"P0", "P1", "S_rect_00"},
                                        {"P_rect_00", "P_rect_01", "S_rect_00"}}};
  const auto has = [&](const std::string& key) { return find_key(lines, key) != nullptr; };
  for (const PairNames& pair : pairs) {
    if (has(pair.left) && has(pair.right)) return pair;
  }
  for (const PairNames& pair : pairs) {
    if (has(pair.left) || has(pair.right)) return pair;
  }
  return pairs.front();
}

void read_size(const CalibrationText& file, const std::vector<KeyLine>& lines, const std::string& key,
               StereoCalibration& calibration) {
  const KeyLine* line = find_key(lines, key);
  if (line == nullptr) return;
  const std::vector<std::string_view> words = split_words(line->value);
  if (words.size() != 2) fail(file.path, ": ", key, " has ", words.size(), " values; it must have 2");
  calibration.width = parse_side(file.path, key, words[0]);
  calibration.height = parse_side(file.path, key, words[1]);
}

void check_pair(const CalibrationText& file, const PairNames& names, const Projection& left, const Projection& right) {
  constexpr double row_tolerance_px = 0.5;
  if (std::abs(left[0] - right[0]) > 1e-6 * std::abs(left[0])) {
    fail(file.path, ": ", names.left, " has the focal length ", left[0], " and ", names.right, " has ", right[0],
         "; a rectified pair has one");
  }
  if (std::abs(left[6] - right[6]) > row_tolerance_px) {
    fail(file.path, ": ", names.left, " has the principal point's row ", left[6], " and ", names.right, " has ",
         right[6], "; a rectified pair has one");
  }
  check_square_pixels(left[0], left[5], file.path, names.left);
}

}  // namespace

CalibrationFile read_kitti(const CalibrationText& file) {
  const std::vector<KeyLine> lines = key_lines(file.text, ':');
  const PairNames names = choose_pair(lines);
  const Projection left = read_projection(file, lines, names.left);
  const Projection right = read_projection(file, lines, names.right);
  StereoCalibration calibration;
  read_size(file, lines, names.size, calibration);
  calibration.focal_px = left[0];
  calibration.cx_px = left[2];
  calibration.cy_px = left[6];
  calibration.disparity_offset_px = right[2] - left[2];
  calibration.baseline_m = left[0] != 0 ? (left[3] - right[3]) / left[0] : 0;
  check_rectified(
      calibration, file.path,
      {names.left + "[0]", names.left + "[2]", names.left + "[6]", names.left + "[3] and " + names.right + "[3]"});
  check_pair(file, names, left, right);
  return {"KITTI " + names.left + "/" + names.right, calibration, std::nullopt};
}

}  // namespace roadstereo::io
