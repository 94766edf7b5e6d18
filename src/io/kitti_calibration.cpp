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
  if (p[1] != 0) fail(file.path, ": ", key, "[1] is ", p[1], "; the pixels of a rectified pair are not skewed: 0");
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
  check_one_projection(file.path, {names.left, left[0], left[6]}, {names.right, right[0], right[6]});
  check_square_pixels(left[0], left[5], file.path, names.left);
  return {"KITTI " + names.left + "/" + names.right, calibration, std::nullopt};
}

}  // namespace roadstereo::io
