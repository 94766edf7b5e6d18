#include "io/calibration_formats.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {

CalibrationFile read_k_txt(const CalibrationText& file) {
  const std::vector<std::string_view> words = split_words(file.text, ",");
  std::array<double, 10> figures{};
  if (words.size() != figures.size()) {
    fail(file.path, ": the file has ", words.size(),
         " figures; a K.txt has the nine of the camera matrix and the baseline in metres");
  }
  const auto name = [](std::size_t i) { return i < 9 ? "K[" + std::to_string(i) + "]" : std::string("the baseline"); };
  for (std::size_t i = 0; i < figures.size(); ++i) figures[i] = parse_figure(file.path, name(i), words[i]);
  if (figures[3] != 0 || figures[6] != 0 || figures[7] != 0 || figures[8] != 1) {
    fail(file.path, ": K is no camera matrix; below its diagonal it must have zeros, and end with 1");
  }
  StereoCalibration calibration;
  calibration.focal_px = figures[0];
  calibration.cx_px = figures[2];
  calibration.cy_px = figures[5];
  calibration.baseline_m = figures[9];
  check_rectified(calibration, file.path, {"K[0]", "K[2]", "K[5]", "the tenth figure"});
  check_square_pixels(figures[0], figures[4], file.path, "K");
  return {"K.txt", calibration, std::nullopt};
}

}  // namespace roadstereo::io
