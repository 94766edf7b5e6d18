#include <gtest/gtest.h>

#include "odometry/alignment_equations.hpp"
#include "odometry/image_pyramid.hpp"

namespace roadstereo {
namespace {

constexpr int width = 97, height = 67;

/// A ramp of grey levels on a plane: both are exact between pixels.
struct Ramp {
  Ramp() : grey(width, height), disparity(width, height), sigma(width, height, 0.1F) {
    for (int v = 0; v < height; ++v) {
      for (int u = 0; u < width; ++u) {
        grey(u, v) = static_cast<std::int16_t>(320 + 8 * u + 12 * v);
        disparity(u, v) = 8 + 0.03125F * static_cast<float>(u) + 0.0625F * static_cast<float>(v);
      }
    }
    pyramid.build(grey.view());
    select_points(maps(), points);
    constexpr double margin = 8;  // no point leaves the view
    std::erase_if(points.levels[0], [](const ReferencePoint& point) {
      return point.u < margin || point.v < margin || point.u > width - margin || point.v > height - margin;
    });
    calibration.focal_px = 120;
    calibration.cx_px = 47;
    calibration.cy_px = 30;
    calibration.baseline_m = 0.2;
  }

  FrameMaps maps() const { return {pyramid, disparity.view(), sigma.view()}; }

  AlignmentEquations at(const AlignmentState& state) const {
    AlignmentEquations equations;
    linearise(points.levels[0], maps(), calibration, 0, state, equations);
    return equations;
  }

  GreyImage grey;
  Image<float> disparity, sigma;
  ImagePyramid pyramid;
  ReferencePoints points;
  StereoCalibration calibration;
};

AlignmentState moved(std::size_t index, double by) {
  AlignmentState state;
  Twist twist{};
  if (index < 6) twist[index] = by;
  state.motion = rigid_motion(twist);
  if (index == gain_index) state.gain += by;
  if (index == brightness_index) state.brightness += by;
  if (index == offset_index) state.offset_px += by;
  if (index == growth_index) state.growth_px += by;
  if (index == shutter_index) state.shutter += by;
  return state;
}

TEST(AlignmentEquations, FrameAgreesWithItself) {
  const Ramp ramp;
  const AlignmentEquations equations = ramp.at({});
  EXPECT_GT(equations.grey.size(), 500U);
  EXPECT_GT(equations.disparity.size(), 500U);
  EXPECT_NEAR(equations.visible, static_cast<double>(equations.grey.size()), 1e-9);
  for (const AlignmentEquation& e : equations.grey) EXPECT_NEAR(e.residual, 0, 1e-4);
  for (const AlignmentEquation& e : equations.disparity) EXPECT_NEAR(e.residual, 0, 1e-5);
}

TEST(AlignmentEquations, RowsAreDerivativesOfResiduals) {
  const Ramp ramp;
  const AlignmentEquations here = ramp.at({});
  constexpr double step = 1e-3;
  for (std::size_t index = 0; index < unknowns; ++index) {
    if (index == shutter_index) continue;  // nothing moves
    const AlignmentEquations more = ramp.at(moved(index, step)), less = ramp.at(moved(index, -step));
    const auto compare = [&](const std::vector<AlignmentEquation>& equations, const auto& beyond, const auto& before) {
      ASSERT_EQ(beyond.size(), equations.size());
      ASSERT_EQ(before.size(), equations.size());
      for (std::size_t i = 0; i < equations.size(); ++i) {
        const double derivative = (beyond[i].residual - before[i].residual) / (2 * step);
        ASSERT_NEAR(equations[i].row[index], derivative, 0.01 * std::abs(derivative) + 0.02) << index << " " << i;
      }
    };
    compare(here.grey, more.grey, less.grey);
    compare(here.disparity, more.disparity, less.disparity);
  }
}

}  // namespace
}  // namespace roadstereo
