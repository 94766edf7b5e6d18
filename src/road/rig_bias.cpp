#include "roadstereo/rig_bias.hpp"

#include <cmath>

#include "core/image_limits.hpp"
#include "core/parallel.hpp"
#include "core/require_range.hpp"
#include "road/rig_bias_field.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo {

double RigBias::at(double u, double v) const {
  const BiasRow<double> row = bias_polynomial<double>(*this).row(v);
  return row.at(u);
}

void RigBias::validate() const {
  constexpr double max_coefficient_px = 1000;
  require_range("rig_bias", "width", width, 1, max_image_side);
  require_range("rig_bias", "height", height, 1, max_image_side);
  require_range("rig_bias", "focal_px", focal_px, 0.0, unlimited);
  if (order != 0) require_range("rig_bias", "order", order, 2, max_order);
  for (const double value : value_px)
    require_range("rig_bias", "value_px", value, -max_coefficient_px, max_coefficient_px);
  for (const double error : std_error_px) require_range("rig_bias", "std_error_px", error, 0.0, unlimited);
  const auto& [first_u, first_v, last_u, last_v] = region_px;
  require_range("rig_bias", "region_px", first_u, 0.0, last_u);
  require_range("rig_bias", "region_px", first_v, 0.0, last_v);
  require_range("rig_bias", "region_px", last_u, 0.0, 1.0 * width);
  require_range("rig_bias", "region_px", last_v, 0.0, 1.0 * height);
}

void RigBias::require_rig(int frame_width, int frame_height,
                          const std::optional<StereoCalibration>& calibration) const {
  if (frame_width != width || frame_height != height) {
    fail("the rig bias is that of ", width, "×", height, " pixels; the frames have ", frame_width, "×", frame_height);
  }
  constexpr double max_difference = 1e-3;
  if (focal_px == 0 || !calibration) return;
  if (std::abs(calibration->focal_px - focal_px) <= max_difference * focal_px) return;
  fail("the rig bias is that of a focal length of ", focal_px, " px; the calibration has ", calibration->focal_px,
       " px, and the two may differ by 0.1 %");
}

void subtract_bias(const BiasPolynomial<float>& bias, int threads, ImageView<float> disparity) {
  constexpr int rows_per_band = 64;
  parallel_rows(disparity.height(), rows_per_band, threads, [&](int first, int last, int) {
    for (int v = first; v < last; ++v) {
      const BiasRow<float> of_row = bias.row(static_cast<float>(v));
      float* const row = disparity.row(v);
      for (int u = 0; u < disparity.width(); ++u) row[u] -= of_row.at(static_cast<float>(u));
    }
  });
}

}  // namespace roadstereo
