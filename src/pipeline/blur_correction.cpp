#include "pipeline/blur_correction.hpp"

#include <algorithm>
#include <cmath>

namespace roadstereo {
namespace {

constexpr double min_std_errors = 2;

/// What is to be equalised: the measurement shrunk by its error (James–Stein), since little is gained where little is
/// known. Two lenses of KITTI differ by 0.1 pixels², to no effect.
double equalised_px2(const BlurDifference& measured) {
  constexpr double min_difference_px2 = 0.2;
  const double size = std::abs(measured.variance_px2), error = measured.stderr_px2;
  if (size < std::max(min_difference_px2, min_std_errors * error)) return 0;
  return measured.variance_px2 * (1 - error * error / (size * size));
}

}  // namespace

bool blur_is_due(const PipelineState& carried) {
  constexpr int frames_between = 100;
  return carried.frames_since_blur == 0 || carried.frames_since_blur >= frames_between;
}

void update_blur(const BlurDifference& measured, PipelineState& carried) {
  carried.frames_since_blur = 0;
  if (!measured.known()) return;
  const double change_px2 = std::abs(measured.variance_px2 - carried.blur_px2);
  if (carried.blur_px2 != 0 && change_px2 < min_std_errors * measured.stderr_px2) return;
  carried.blur_px2 = equalised_px2(measured);
}

}  // namespace roadstereo
