#include "io/calibration_formats.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {

CalibrationFile read_k_txt(const CalibrationText& file) {
  const std::vector<std::string_view> words = split_words(file.text, ",");
  std::array<double, 10> values{};
  if (words.size() != values.size()) {
    fail(file.path, ": the file has ", words.size(),
         " values; a K.txt has 10: the camera matrix and the baseline in metres");
  }
  const auto name = [](std::size_t i) { return i < 9 ? "K[" + std::to_string(i) + "]" : std::string("the baseline"); };
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = parse_number(file.path, name(i), words[i]);
  if (values[3] != 0 || values[6] != 0 || values[7] != 0 || values[8] != 1) {
    fail(file.path, ": K is not a camera matrix; it must be upper triangular and end with 1");
  }
  if (values[1] != 0) fail(file.path, ": K[1] is ", values[1], "; the pixels of a rectified pair are not skewed: 0");
  StereoCalibration calibration;
  calibration.focal_px = values[0];
  calibration.cx_px = values[2];
  calibration.cy_px = values[5];
  calibration.baseline_m = values[9];
  check_rectified(calibration, file.path, {"K[0]", "K[2]", "K[5]", "the tenth value"});
  check_square_pixels(values[0], values[4], file.path, "K");
  return {"K.txt", calibration, std::nullopt};
}

}  // namespace roadstereo::io
