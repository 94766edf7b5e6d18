#include "io/calibration_formats.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

constexpr double metres_per_millimetre = 1e-3;

std::string_view value_of(const CalibrationText& file, const std::vector<KeyLine>& lines, const std::string& key) {
  const KeyLine* line = find_key(lines, key);
  if (line == nullptr) fail(file.path, ": ", key, " is missing");
  return line->value;
}

/// "[f 0 cx; 0 f cy; 0 0 1]".
std::array<double, 9> read_camera(const CalibrationText& file, const std::vector<KeyLine>& lines,
                                  const std::string& key) {
  const std::vector<std::string_view> words = split_words(value_of(file, lines, key), "[];,");
  std::array<double, 9> k{};
  if (words.size() != k.size()) fail(file.path, ": ", key, " has ", words.size(), " values; it must have 9");
  for (std::size_t i = 0; i < k.size(); ++i) {
    k[i] = parse_number(file.path, key + "[" + std::to_string(i) + "]", words[i]);
  }
  return k;
}

int read_side(const CalibrationText& file, const std::vector<KeyLine>& lines, const std::string& key) {
  const KeyLine* line = find_key(lines, key);
  return line == nullptr ? 0 : parse_side(file.path, key, line->value);
}

}  // namespace

CalibrationFile read_middlebury(const CalibrationText& file) {
  const std::vector<KeyLine> lines = key_lines(file.text, '=');
  const std::array<double, 9> left = read_camera(file, lines, "cam0");
  const std::array<double, 9> right = read_camera(file, lines, "cam1");
  StereoCalibration calibration;
  calibration.width = read_side(file, lines, "width");
  calibration.height = read_side(file, lines, "height");
  calibration.focal_px = left[0];
  calibration.cx_px = left[2];
  calibration.cy_px = left[5];
  calibration.disparity_offset_px = find_key(lines, "doffs") != nullptr
                                        ? parse_number(file.path, "doffs", value_of(file, lines, "doffs"))
                                        : right[2] - left[2];
  calibration.baseline_m =
      metres_per_millimetre * parse_number(file.path, "baseline", value_of(file, lines, "baseline"));
  check_rectified(calibration, file.path,
                  {"cam0[0]", "cam0[2]", "cam0[5]", "\"baseline\", which this format gives in millimetres"});
  check_square_pixels(left[0], left[4], file.path, "cam0");
  check_one_projection(file.path, {"cam0", left[0], left[5]}, {"cam1", right[0], right[5]});
  return {"Middlebury", calibration, std::nullopt};
}

}  // namespace roadstereo::io
