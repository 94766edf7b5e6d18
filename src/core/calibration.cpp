#include "roadstereo/calibration.hpp"

#include <cmath>

#include "roadstereo/error.hpp"

namespace roadstereo {

void StereoCalibration::validate(int image_width, int image_height, const std::string& source) const {
  const auto require = [&](bool good, const char* name, double value, auto&&... rule) {
    if (!good) fail(source, ": ", name, " is ", value, "; ", rule...);
  };
  const auto finite = [&](const char* name, double value) {
    require(std::isfinite(value), name, value, "it must be a finite number");
  };
  finite("the focal length", focal_px);
  finite("the principal point's column", cx_px);
  finite("the principal point's row", cy_px);
  finite("the baseline", baseline_m);
  finite("the disparity offset", disparity_offset_px);

  if (width != 0 && (width != image_width || height != image_height)) {
    fail(source, ": the calibration is for ", width, "×", height, " pixels, but the images have ", image_width, "×",
         image_height, ": scale the calibration, or record at ", width, "×", height);
  }
  const double w = image_width;
  const double h = image_height;
  require(focal_px >= 0.2 * w && focal_px <= 50 * w, "the focal length", focal_px, "for images ", image_width,
          " pixels wide it must be between ", 0.2 * w, " and ", 50 * w, " pixels");
  require(baseline_m >= 0.005 && baseline_m <= 10, "the baseline", baseline_m,
          "it must be between 0.005 and 10 metres");
  require(cx_px >= -w && cx_px <= 2 * w, "the principal point's column", cx_px, "it must be between ", -w, " and ",
          2 * w, " pixels");
  require(cy_px >= -h && cy_px <= 2 * h, "the principal point's row", cy_px, "it must be between ", -h, " and ", 2 * h,
          " pixels");
  require(std::abs(disparity_offset_px) <= w, "the disparity offset", disparity_offset_px,
          "it must be smaller than the image width");
}

}  // namespace roadstereo
