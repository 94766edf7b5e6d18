#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "odometry/alignment_equations.hpp"
#include "odometry/image_pyramid.hpp"
#include "tests/core/every_target.hpp"

namespace roadstereo {
namespace {

struct Equation {
  std::array<double, unknowns> row;
  double residual, variance;
  int cell;
};

/// Those of all blocks, in order.
std::vector<Equation> listed(const EquationBlocks& blocks) {
  std::vector<Equation> equations;
  for (const EquationBlock& block : blocks) {
    for (std::size_t lane = 0; lane < EquationBlock::lanes; ++lane) {
      Equation e{{}, block.residual[lane], block.variance[lane], block.cell[lane]};
      for (std::size_t i = 0; i < unknowns; ++i) e.row[i] = block.row[i][lane];
      if (block.valid[lane]) equations.push_back(e);
    }
  }
  return equations;
}

struct Equations {
  std::vector<Equation> grey, disparity;
  double visible;
};

using AlignmentEquationsTarget = test::EveryTarget;

/// A plane that two frames see, and a ramp of grey levels: disparities and grey levels are exact between pixels.
class PlaneInTwoFrames {
 public:
  static constexpr int width = 97, height = 67;

  explicit PlaneInTwoFrames(const RigidMotion& motion)
      : motion_(motion), grey_(width, height), disparity_(width, height), moved_(width, height), sigma_(width, height) {
    calibration_.focal_px = 120;
    calibration_.cx_px = 47;
    calibration_.cy_px = 30;
    calibration_.baseline_m = 0.2;
    // N·p = baseline for points of the plane, and N'·q = b after the motion.
    const Vector<3> normal{slope_u, slope_v, centre / calibration_.focal_px};
    const Vector<3> turned = motion.rotated(normal);
    const double scale = calibration_.baseline_m / (calibration_.baseline_m + dot(turned, motion.translation));
    for (int v = 0; v < height; ++v) {
      for (int u = 0; u < width; ++u) {
        const double x = u - calibration_.cx_px, y = v - calibration_.cy_px;
        grey_(u, v) = static_cast<std::int16_t>(320 + 8 * u + 12 * v);
        disparity_(u, v) = static_cast<float>(slope_u * x + slope_v * y + centre);
        moved_(u, v) = static_cast<float>(scale * (turned[0] * x + turned[1] * y + turned[2] * calibration_.focal_px));
        sigma_(u, v) = sigma;
      }
    }
    pyramid_.build(grey_.view());
    ReferencePoints points;
    select_points({pyramid_, disparity_.view(), sigma_.view()}, points);
    constexpr double margin = 12;  // no point leaves the view
    for (const ReferencePoint& point : points.levels[0]) {
      if (point.u > margin && point.v > margin && point.u < width - margin && point.v < height - margin)
        points_.push_back(point);
    }
  }

  const std::vector<ReferencePoint>& points() const { return points_; }
  const StereoCalibration& calibration() const { return calibration_; }

  /// At the motion, with one unknown moved on.
  Equations at(std::size_t index = 0, double by = 0) const { return at(points_, index, by); }

  Equations at(const std::vector<ReferencePoint>& points, std::size_t index = 0, double by = 0) const {
    AlignmentState state;
    Twist twist{};
    if (index < twist.size()) twist[index] = by;
    state.motion = rigid_motion(twist) * motion_;
    if (index == gain_index) state.gain += by;
    if (index == brightness_index) state.brightness += by;
    if (index == offset_index) state.offset_px += by;
    if (index == growth_index) state.growth_px += by;
    if (index == shutter_index) state.shutter += by;
    AlignmentEquations equations;
    linearise(points, {pyramid_, moved_.view(), sigma_.view()}, calibration_, 0, state, 1, equations);
    EXPECT_EQ(equations.seen, listed(equations.grey).size());
    return {listed(equations.grey), listed(equations.disparity), equations.visible};
  }

  /// Of the second frame.
  Image<float>& disparity() { return moved_; }
  Image<float>& sigma_map() { return sigma_; }
  AlignmentEquations blocks(const std::vector<ReferencePoint>& points) const {
    AlignmentEquations equations;
    AlignmentState state;
    state.motion = motion_;
    linearise(points, {pyramid_, moved_.view(), sigma_.view()}, calibration_, 0, state, 1, equations);
    return equations;
  }

  static constexpr double slope_u = 0.03, slope_v = 0.06, centre = 11;
  static constexpr float sigma = 0.125F;

 private:
  RigidMotion motion_;
  GreyImage grey_;
  Image<float> disparity_, moved_, sigma_;
  ImagePyramid pyramid_;
  StereoCalibration calibration_;
  std::vector<ReferencePoint> points_;
};

const RigidMotion motion = rigid_motion({0.03, -0.02, 0.15, 0.01, -0.02, 0.015});

TEST_P(AlignmentEquationsTarget, RowsAreDerivativesOfResiduals) {
  const PlaneInTwoFrames scene(motion);
  const Equations here = scene.at();
  ASSERT_GT(scene.points().size(), 100U);
  ASSERT_EQ(here.grey.size(), scene.points().size());
  ASSERT_EQ(here.disparity.size(), scene.points().size());
  constexpr double step = 2e-3;
  for (std::size_t index = 0; index < unknowns; ++index) {
    const Equations more = scene.at(index, step), less = scene.at(index, -step);
    const auto compare = [&](const std::vector<Equation>& equations, const auto& beyond, const auto& before) {
      ASSERT_EQ(beyond.size(), equations.size());
      ASSERT_EQ(before.size(), equations.size());
      for (std::size_t i = 0; i < equations.size(); ++i) {
        const double derivative = (beyond[i].residual - before[i].residual) / (2 * step);
        // Single precision of grey levels and disparities, 10⁻⁵, by the step; and the third derivative.
        ASSERT_NEAR(equations[i].row[index], derivative, 5e-3 + 1e-4 * std::abs(derivative)) << index << " " << i;
      }
    };
    compare(here.grey, more.grey, less.grey);
    compare(here.disparity, more.disparity, less.disparity);
  }
}

TEST_P(AlignmentEquationsTarget, DisparitiesOfPlaneAgree) {
  const PlaneInTwoFrames scene(motion);
  const Equations equations = scene.at();
  for (const Equation& e : equations.disparity) EXPECT_NEAR(e.residual, 0, 1e-5);  // single precision
}

TEST_P(AlignmentEquationsTarget, VariancesAreThoseOfDisparities) {
  const PlaneInTwoFrames scene(motion);
  const Equations equations = scene.at();
  for (std::size_t i = 0; i < equations.grey.size(); ++i) {
    // The offset moves the disparity of a point by its shape, 1 + x² of the right camera.
    const ReferencePoint& point = scene.points()[i];
    const StereoCalibration& calibration = scene.calibration();
    const double right = (point.u - point.disparity - calibration.cx_px) / calibration.focal_px;
    const double shape = 1 + right * right;
    const double error = equations.grey[i].row[offset_index] / shape * PlaneInTwoFrames::sigma;
    EXPECT_NEAR(equations.grey[i].variance, error * error, 1e-9 + 1e-6 * error * error);
    const double own = PlaneInTwoFrames::sigma;
    EXPECT_GT(equations.disparity[i].variance, own * own);
    EXPECT_LT(equations.disparity[i].variance, 3 * own * own);
  }
}

TEST_P(AlignmentEquationsTarget, PointsSeenFromFartherAwayCountByTheirArea) {
  const PlaneInTwoFrames scene(motion);
  double areas = 0;
  for (const ReferencePoint& point : scene.points()) {
    const Vector<3> p = scene.calibration().point_m(point.u, point.v, point.disparity);
    const double scale = p[2] / motion(p)[2];
    areas += std::min(1.0, scale * scale);
  }
  EXPECT_LT(areas, 0.99 * static_cast<double>(scene.points().size()));
  EXPECT_NEAR(scene.at().visible, areas, 1e-9 * areas);
}

TEST_P(AlignmentEquationsTarget, NeighboursInVectorsDoNotMatter) {
  const PlaneInTwoFrames scene(motion);
  const Equations all = scene.at();
  ASSERT_NE(scene.points().size() % 8, 0U);  // the last vector is not full
  for (std::size_t i = 0; i < scene.points().size(); ++i) {
    const Equations one = scene.at({scene.points()[i]});
    ASSERT_EQ(one.grey.size(), 1U);
    ASSERT_EQ(one.disparity.size(), 1U);
    EXPECT_EQ(one.grey[0].row, all.grey[i].row);
    EXPECT_EQ(one.grey[0].residual, all.grey[i].residual);
    EXPECT_EQ(one.disparity[0].row, all.disparity[i].row);
    EXPECT_EQ(one.disparity[0].residual, all.disparity[i].residual);
    EXPECT_EQ(one.disparity[0].cell, scene.points()[i].cell);
  }
}

// One point in each lane; what spoils it must not touch its neighbours.
TEST_P(AlignmentEquationsTarget, WhatIsNotSeenHasNoEquation) {
  PlaneInTwoFrames scene{RigidMotion{}};
  std::vector<ReferencePoint> points;
  for (std::size_t i = 0; i < EquationBlock::lanes; ++i) points.push_back(scene.points()[10 * i]);
  const auto pixel = [&points](Image<float>& map, std::size_t i) -> float& {
    return map(static_cast<int>(points[i].u), static_cast<int>(points[i].v));
  };
  const AlignmentEquations before = scene.blocks(points);
  ASSERT_EQ(before.seen, points.size());
  points[1].u = PlaneInTwoFrames::width - 1;
  points[2].disparity = -5;  // behind the camera
  pixel(scene.disparity(), 3) = NAN;
  pixel(scene.disparity(), 4) += 2;  // another surface
  pixel(scene.sigma_map(), 5) = 0;
  pixel(scene.sigma_map(), 6) = NAN;
  const AlignmentEquations after = scene.blocks(points);
  EXPECT_EQ(after.seen, points.size() - 2);
  const auto expect_none = [](const EquationBlock& block, std::size_t lane) {
    EXPECT_FALSE(block.valid[lane]) << lane;
    EXPECT_EQ(block.residual[lane], 0) << lane;
    EXPECT_EQ(block.variance[lane], 1) << lane;
    for (const EquationBlock::Lanes& row : block.row) EXPECT_EQ(row[lane], 0) << lane;
  };
  for (const std::size_t lane : {1U, 2U}) expect_none(after.grey[0], lane);
  for (const std::size_t lane : {1U, 2U, 3U, 4U, 5U, 6U}) expect_none(after.disparity[0], lane);
  for (const std::size_t lane : {0U, 3U, 4U, 5U, 6U, 7U}) {
    EXPECT_TRUE(after.grey[0].valid[lane]) << lane;
    EXPECT_EQ(after.grey[0].residual[lane], before.grey[0].residual[lane]) << lane;
  }
  for (const std::size_t lane : {0U, 7U}) {
    EXPECT_TRUE(after.disparity[0].valid[lane]) << lane;
    EXPECT_EQ(after.disparity[0].variance[lane], before.disparity[0].variance[lane]) << lane;
  }
}

// Numbers whose products and sums are exact.
TEST_P(AlignmentEquationsTarget, ProductsAreSumsOverEquations) {
  AlignmentEquations equations;
  equations.grey.resize(3);
  int number = 0;
  const auto next = [&number] { return (++number * 7) % 23 - 11; };
  for (EquationBlock& block : equations.grey) {
    for (std::size_t lane = 0; lane < EquationBlock::lanes; ++lane) {
      for (auto& row : block.row) row[lane] = next();
      block.residual[lane] = next();
      block.weight[lane] = next() * 0.25;
    }
  }
  Matrix<unknowns + 1> sums{};
  sums[3][2] = 5;  // is added to
  add_products(equations.grey, sums);
  for (std::size_t i = 0; i <= unknowns; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      double expected = i == 3 && j == 2 ? 5 : 0;
      for (const EquationBlock& block : equations.grey) {
        for (std::size_t lane = 0; lane < EquationBlock::lanes; ++lane) {
          const auto element = [&](std::size_t k) { return k < unknowns ? block.row[k][lane] : block.residual[lane]; };
          expected += block.weight[lane] * element(i) * element(j);
        }
      }
      EXPECT_EQ(sums[i][j], expected) << i << ", " << j;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Machine, AlignmentEquationsTarget, testing::ValuesIn(test::targets_of_this_machine()),
                         test::name_of_target);

}  // namespace
}  // namespace roadstereo
