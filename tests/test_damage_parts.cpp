// What damage segmentation is made of, against closed forms and brute force.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <set>
#include <vector>

#include "damage/cells.hpp"
#include "damage/connected_regions.hpp"
#include "damage/depth_cells.hpp"
#include "damage/grow.hpp"
#include "damage/oriented_box.hpp"
#include "damage/road_surface.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/road_plane.hpp"

namespace roadstereo {
namespace {

constexpr float none = std::numeric_limits<float>::quiet_NaN();
constexpr double degree = std::numbers::pi / 180;

Image<std::uint8_t> random_mask(int width, int height, double share, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::bernoulli_distribution set(share);
  Image<std::uint8_t> mask(width, height);
  for (int j = 0; j < height; ++j) {
    for (int i = 0; i < width; ++i) mask(i, j) = set(random) ? 255 : 0;
  }
  return mask;
}

/// Numbers every cell by the smallest cell that it hangs together with: the smallest number spreads until nothing
/// changes. −1 where the mask is not `wanted`.
Image<int> spread_numbers(const Image<std::uint8_t>& mask, bool wanted) {
  Image<int> number(mask.width(), mask.height(), -1);
  for (int j = 0; j < mask.height(); ++j) {
    for (int i = 0; i < mask.width(); ++i) {
      if ((mask(i, j) != 0) == wanted) number(i, j) = j * mask.width() + i;
    }
  }
  for (bool changed = true; changed;) {
    changed = false;
    const auto take = [&](int i, int j, int di, int dj) {
      if (i + di < 0 || j + dj < 0 || i + di >= mask.width() || j + dj >= mask.height()) return;
      const int other = number(i + di, j + dj);
      if (other < 0 || other >= number(i, j)) return;
      number(i, j) = other;
      changed = true;
    };
    for (int j = 0; j < mask.height(); ++j) {
      for (int i = 0; i < mask.width(); ++i) {
        for (const auto& [di, dj] : {std::array{1, 0}, std::array{-1, 0}, std::array{0, 1}, std::array{0, -1}}) {
          take(i, j, di, dj);
        }
      }
    }
  }
  return number;
}

class RandomMasks : public testing::TestWithParam<int> {
 protected:
  Image<std::uint8_t> mask() const {
    const int k = GetParam();
    return random_mask(1 + 7 * k % 41, 1 + 11 * k % 37, 0.2 + 0.1 * (k % 6), static_cast<std::uint32_t>(k));
  }
};

TEST_P(RandomMasks, RegionsAreThoseOfBruteForce) {
  const Image<std::uint8_t> cells = mask();
  const Image<int> number = spread_numbers(cells, true);
  const ConnectedRegions regions(cells);
  std::set<int> numbers;
  std::size_t set = 0;
  for (int j = 0; j < cells.height(); ++j) {
    for (int i = 0; i < cells.width(); ++i) {
      if (cells(i, j) == 0) continue;
      numbers.insert(number(i, j));
      ++set;
    }
  }
  ASSERT_EQ(regions.size(), numbers.size());
  std::size_t total = 0;
  int last_first = -1;
  for (const ConnectedRegion& region : regions) {
    total += region.size;
    const int first = region.runs.front().row * cells.width() + region.runs.front().first;
    EXPECT_GT(first, last_first) << "in the order of their first cells";
    last_first = first;
    int u0 = 1000, v0 = 1000, u1 = -1, v1 = -1;
    std::set<int> held;
    for (const CellRun& run : region.runs) {
      for (int i = run.first; i <= run.last; ++i) {
        EXPECT_EQ(number(i, run.row), first);
        held.insert(run.row * cells.width() + i);
      }
      u0 = std::min(u0, run.first);
      v0 = std::min(v0, run.row);
      u1 = std::max(u1, run.last);
      v1 = std::max(v1, run.row);
    }
    EXPECT_EQ(held.size(), region.size);
    EXPECT_EQ(region.box.first_column, u0);
    EXPECT_EQ(region.box.first_row, v0);
    EXPECT_EQ(region.box.last_column, u1);
    EXPECT_EQ(region.box.last_row, v1);
    EXPECT_EQ(region.touches_border, u0 == 0 || v0 == 0 || u1 == cells.width() - 1 || v1 == cells.height() - 1);
  }
  EXPECT_EQ(total, set);
}

TEST_P(RandomMasks, EnclosedPartsAreFilledUpToTheirSize) {
  const Image<std::uint8_t> before = mask();
  const Image<int> number = spread_numbers(before, false);
  for (const std::size_t most : {std::size_t{0}, std::size_t{1}, std::size_t{3}, std::size_t{10'000}}) {
    Image<std::uint8_t> filled = before;
    fill_enclosed(filled, most);
    for (int j = 0; j < before.height(); ++j) {
      for (int i = 0; i < before.width(); ++i) {
        if (before(i, j) != 0) {
          EXPECT_EQ(filled(i, j), before(i, j));
          continue;
        }
        std::size_t size = 0;
        bool at_border = false;
        for (int y = 0; y < before.height(); ++y) {
          for (int x = 0; x < before.width(); ++x) {
            if (number(x, y) != number(i, j)) continue;
            ++size;
            at_border |= x == 0 || y == 0 || x + 1 == before.width() || y + 1 == before.height();
          }
        }
        EXPECT_EQ(filled(i, j) != 0, !at_border && size <= most) << i << ", " << j;
      }
    }
  }
}

TEST_P(RandomMasks, GrowAndShrinkAreThoseOfBruteForce) {
  const Image<std::uint8_t> cells = mask();
  for (const int radius : {0, 1, 2, 5, 60}) {
    const Image<std::uint8_t> grown = grow(cells, radius);
    const Image<std::uint8_t> shrunk = shrink_mask(cells, radius);
    for (int j = 0; j < cells.height(); ++j) {
      for (int i = 0; i < cells.width(); ++i) {
        bool any = false, all = true;
        for (int y = std::max(0, j - radius); y <= std::min(cells.height() - 1, j + radius); ++y) {
          for (int x = std::max(0, i - radius); x <= std::min(cells.width() - 1, i + radius); ++x) {
            any |= cells(x, y) != 0;
            all &= cells(x, y) != 0;
          }
        }
        ASSERT_EQ(grown(i, j), any ? 255 : 0) << "radius " << radius << " at " << i << ", " << j;
        ASSERT_EQ(shrunk(i, j), all ? 255 : 0) << "radius " << radius << " at " << i << ", " << j;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomMasks, testing::Range(1, 13));

TEST(Boxes, GrowWithinTheImage) {
  Box box;
  EXPECT_TRUE(box.empty());
  box.add(5, 7);
  box.add(3, 9);
  const Box grown = box.grown(4, 8, 40);
  EXPECT_EQ(grown.first_column, 0);
  EXPECT_EQ(grown.first_row, 3);
  EXPECT_EQ(grown.last_column, 7);
  EXPECT_EQ(grown.last_row, 13);
}

using Points = std::vector<std::array<double, 2>>;

/// Points along the sides of a rectangle and within it.
Points rectangle(double length, double width, double angle) {
  Points points;
  for (const double a : {-0.5, -0.3, 0.0, 0.25, 0.5}) {
    for (const double b : {-0.5, -0.1, 0.2, 0.5}) {
      const double x = a * length, y = b * width;
      points.push_back({3 + std::cos(angle) * x - std::sin(angle) * y, -2 + std::sin(angle) * x + std::cos(angle) * y});
    }
  }
  return points;
}

TEST(OrientedBoxes, OfARectangleAtEveryAngle) {
  for (int k = -178; k <= 180; k += 2) {
    const OrientedBox box = oriented_box(rectangle(3, 1.25, k * degree));
    EXPECT_NEAR(box.length, 3, 1e-9) << k;
    EXPECT_NEAR(box.width, 1.25, 1e-9) << k;
    EXPECT_LE(std::abs(box.angle_rad), std::numbers::pi / 2 + 1e-12) << k;
    EXPECT_NEAR(std::sin(box.angle_rad - k * degree), 0, 1e-9) << k << ": the same line";
  }
}

/// One side of the smallest rectangle lies on a side of the triangle: all three have twice its area; the shortest
/// perimeter is not what is asked for.
TEST(OrientedBoxes, OfATriangleHasTwiceItsArea) {
  const OrientedBox box = oriented_box({{0, 0}, {4, 0}, {1, 2}});
  EXPECT_NEAR(box.length * box.width, 8, 1e-12);
}

TEST(OrientedBoxes, OfACircleIsItsDiameter) {
  Points points;
  for (int k = 0; k < 720; ++k) points.push_back({2 * std::cos(k * degree / 2), 2 * std::sin(k * degree / 2)});
  const OrientedBox box = oriented_box(points);
  EXPECT_NEAR(box.length, 4, 1e-4);
  EXPECT_NEAR(box.width, 4, 1e-4);
}

TEST(OrientedBoxes, OfFewPoints) {
  for (const Points& points : {Points{}, Points{{3, 4}}, Points{{3, 4}, {3, 4}, {3, 4}}}) {
    const OrientedBox box = oriented_box(points);
    EXPECT_EQ(box.length, 0);
    EXPECT_EQ(box.width, 0);
    EXPECT_EQ(box.angle_rad, 0);
  }
  for (const Points& line : {Points{{0, 0}, {3, 4}}, Points{{1.5, 2}, {3, 4}, {0, 0}, {0.75, 1}}}) {
    const OrientedBox box = oriented_box(line);
    EXPECT_NEAR(box.length, 5, 1e-12);
    EXPECT_NEAR(box.width, 0, 1e-12);
    EXPECT_NEAR(box.angle_rad, std::atan2(4, 3), 1e-12);
  }
  const OrientedBox upright = oriented_box({{1, 5}, {1, -1}, {1, 2}});
  EXPECT_NEAR(upright.length, 6, 1e-12);
  EXPECT_NEAR(std::abs(upright.angle_rad), std::numbers::pi / 2, 1e-12);
}

TEST(InterpolateGaps, RestoresALinearField) {
  const double across = 0.03, down = -0.05;
  const auto field = [&](int i, int j) { return static_cast<float>(7 + across * i + down * j); };
  for (const int radius : {2, 5, 10}) {
    Image<float> values(97, 71);
    Image<std::uint8_t> known(97, 71, 255);
    for (int j = 0; j < 71; ++j) {
      for (int i = 0; i < 97; ++i) {
        values(i, j) = field(i, j);
        for (const auto& [u, v] : {std::array{25, 30}, std::array{62, 41}}) {
          if ((i - u) * (i - u) + (j - v) * (j - v) <= radius * radius) known(i, j) = 0;
        }
        if (known(i, j) == 0) values(i, j) = none;
      }
    }
    interpolate_gaps(values, known);
    const double rise = 2 * radius * std::hypot(across, down);  // of the field over the gap
    double worst = 0;
    for (int j = 0; j < 71; ++j) {
      for (int i = 0; i < 97; ++i) {
        if (known(i, j) != 0) {
          ASSERT_EQ(values(i, j), field(i, j));
        }
        worst = std::max(worst, static_cast<double>(std::abs(values(i, j) - field(i, j))));
      }
    }
    EXPECT_LT(worst, 0.35 * rise) << "radius " << radius;  // a constant would be wrong by half of it
  }
}

TEST(InterpolateGaps, OneKnownCellFillsEverything) {
  Image<float> values(33, 20, none);
  Image<std::uint8_t> known(33, 20, 0);
  values(31, 2) = 4.5F;
  known(31, 2) = 255;
  interpolate_gaps(values, known);
  for (int j = 0; j < 20; ++j) {
    for (int i = 0; i < 33; ++i) ASSERT_NEAR(values(i, j), 4.5, 1e-5);
  }
}

TEST(CellMeans, AreThoseOfTheValidPixels) {
  Image<float> map(7, 5, none);
  map(0, 0) = 2;
  map(1, 0) = 4;
  map(2, 0) = 9;  // alone in its cell
  map(3, 3) = 1;
  map(2, 2) = std::numeric_limits<float>::infinity();
  map(2, 3) = 3;
  map(6, 0) = 5;  // half of a cell that the border cuts
  const Cells cells = make_cells(map, {}, 2, 1);
  ASSERT_EQ(cells.width(), 4);
  ASSERT_EQ(cells.height(), 3);
  EXPECT_EQ(cells.value(0, 0), 3);
  EXPECT_TRUE(std::isnan(cells.value(1, 0)));
  EXPECT_EQ(cells.value(1, 1), 2);
  EXPECT_EQ(cells.value(3, 0), 5);
}

/// A rig with an offset of the principal points, over a road seen at an angle and tilted sideways.
StereoCalibration tilted_rig() {
  return {500, 150.5, 99.5, 0.2, 3, 300, 200};
}
const RoadModel tilted_road{40, 0.1, 0.02};

/// n·p = h on the road and h − z above it: from a ray's direction alone.
double disparity_above(const RoadPlane& plane, const StereoCalibration& rig, double u, double v, double lift_m) {
  const std::array<double, 3> ray{(u - rig.cx_px) / rig.focal_px, (v - rig.cy_px) / rig.focal_px, 1};
  const double along = plane.normal[0] * ray[0] + plane.normal[1] * ray[1] + plane.normal[2];
  return rig.focal_px * rig.baseline_m * along / (plane.height_m - lift_m) - rig.disparity_offset_px;
}

TEST(SurfaceScale, IsTheChangeOfDisparityPerMetre) {
  Cells cells;
  cells.factor = 2;
  cells.value.assign(150, 100, 30.0F);
  DamageInput input;
  input.calibration = tilted_rig();
  input.plane = tilted_road;
  const SurfaceCoordinates c = surface_coordinates(cells, input);
  const RoadPlane plane = road_plane(tilted_road, tilted_rig());
  const RoadFrame frame = road_frame(plane);
  constexpr double lift_m = 1e-5;
  for (int j = 0; j < cells.height(); j += 9) {
    for (int i = 0; i < cells.width(); i += 7) {
      const double u = cells.middle(i), v = cells.middle(j);
      const double there = disparity_above(plane, tilted_rig(), u, v, 0);
      ASSERT_NEAR(there, tilted_road.disparity(u, v), 1e-9);
      const double change = (disparity_above(plane, tilted_rig(), u, v, lift_m) - there) / lift_m;
      EXPECT_NEAR(c.scale(i, j), change, 1e-4 * change);
      const auto point = frame.to_road(tilted_rig().point_m(u, v, there));
      EXPECT_NEAR(c.x(i, j), point[0], 1e-6);
      EXPECT_NEAR(c.y(i, j), point[1], 1e-6);
    }
  }
}

/// A quadratic of the coordinates with noise and, in `spoilt` of the cells, anything.
struct QuadraticRoad {
  Cells cells;
  SurfaceCoordinates coordinates;
  Image<float> truth;

  QuadraticRoad(const DamageInput& input, const std::array<double, 6>& k, double noise, double spoilt) {
    std::mt19937 random(5);
    std::normal_distribution<double> normal(0, 1);
    std::uniform_real_distribution<double> share(0, 1);
    cells.factor = 1;
    cells.value.assign(300, 200, 30.0F);
    truth.assign(300, 200, 0);
    coordinates = surface_coordinates(cells, input);
    for (int j = 0; j < 200; ++j) {
      for (int i = 0; i < 300; ++i) {
        const double x = coordinates.x(i, j), y = coordinates.y(i, j);
        const double height = k[1] * x + k[2] * y + k[3] * x * x + k[4] * x * y + k[5] * y * y;
        truth(i, j) = static_cast<float>(30 + coordinates.scale(i, j) * height);
        const bool bad = share(random) < spoilt;
        const double error = bad ? -1 - 12 * share(random) : noise * normal(random);
        cells.value(i, j) = truth(i, j) + static_cast<float>(error);
      }
    }
  }

  double worst(const RoadSurface& surface) const {
    double most = 0;
    for (int j = 0; j < 200; ++j) {
      for (int i = 0; i < 300; ++i) {
        most = std::max(most, static_cast<double>(std::abs(surface.value(i, j) - truth(i, j))));
      }
    }
    return most;
  }
};

DamageInput calibrated() {
  DamageInput input;
  input.calibration = tilted_rig();
  input.plane = tilted_road;
  return input;
}

// Metres of height with a calibration, pixels of ℓ' without.
constexpr std::array<double, 6> camber_m{0, 0.004, -0.002, -0.006, 0.002, 0.003};
constexpr std::array<double, 6> camber_px{0, 0.3, -0.2, -0.5, 0.15, 0.25};

TEST(RoadSurfaceFit, IsExactBelowOutliersOfOneSide) {
  for (const bool metric : {true, false}) {
    const QuadraticRoad road(metric ? calibrated() : DamageInput{}, metric ? camber_m : camber_px, 0, 0.3);
    EXPECT_LT(road.worst(fit_road_surface(road.cells, road.coordinates)), 1e-4) << metric;
  }
}

/// Six coefficients from n samples: the standard error of a value is σ·√(6/n) on average, thrice that in a corner; that
/// of a normal distribution's median absolute deviation is 1.17/√n of it.
TEST(RoadSurfaceFit, IsAsGoodAsTheNoiseAllows) {
  constexpr double noise = 0.05, spoilt = 0.3;
  const Image<std::uint8_t> everywhere(300, 200, 255);
  for (const bool metric : {true, false}) {
    const QuadraticRoad road(metric ? calibrated() : DamageInput{}, metric ? camber_m : camber_px, noise, spoilt);
    const auto check = [&](const RoadSurface& surface, int step) {
      const double samples = 300.0 * 200 / (step * step) * (1 - spoilt);
      EXPECT_LT(road.worst(surface), 4 * 3 * noise * std::sqrt(6 / samples)) << metric << ", step " << step;
      EXPECT_NEAR(surface.noise, noise, 3 * 1.17 / std::sqrt(samples) * noise) << metric << ", step " << step;
    };
    const RoadSurface rough = fit_road_surface(road.cells, road.coordinates);
    check(rough, 7);
    check(refit_road_surface(road.cells, road.coordinates, everywhere, rough, Sampling::fine), 4);
  }
}

TEST(RoadSurfaceFit, LooksOnlyAtTheRegion) {
  QuadraticRoad road({}, camber_px, 0, 0);
  RoadSurface earlier = fit_road_surface(road.cells, road.coordinates);
  earlier.noise = 0.1;
  Image<std::uint8_t> region(300, 200, 255);
  for (int j = 0; j < 200; ++j) {
    for (int i = 100; i < 300; ++i) {
      region(i, j) = 0;
      road.cells.value(i, j) += 0.3F;  // two thirds of the picture, within the reach of the weights
    }
  }
  EXPECT_LT(road.worst(refit_road_surface(road.cells, road.coordinates, region, earlier, Sampling::fine)), 1e-3);
  region.assign(300, 200, 0);
  EXPECT_THROW(refit_road_surface(road.cells, road.coordinates, region, earlier, Sampling::fine), Error);
}

/// Of a single row of cells nothing can be said across it; along it the fit is exact.
TEST(RoadSurfaceFit, LeavesOutWhatTheSamplesDoNotTellApart) {
  constexpr int only = 102;
  const QuadraticRoad road({}, camber_px, 0, 0);
  RoadSurface earlier = fit_road_surface(road.cells, road.coordinates);
  earlier.noise = 0.1;
  Image<std::uint8_t> region(300, 200, 0);
  for (int i = 0; i < 300; ++i) region(i, only) = 255;
  const RoadSurface surface = refit_road_surface(road.cells, road.coordinates, region, earlier, Sampling::fine);
  for (int i = 0; i < 300; ++i) {
    ASSERT_NEAR(surface.value(i, only), road.truth(i, only), 1e-4) << i;
    ASSERT_NEAR(surface.value(i, 0), road.truth(i, only), 1e-4) << i;
  }
}

double dot(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

void expect_right_handed(const RoadFrame& frame) {
  for (const auto& axis : {frame.x, frame.y, frame.z}) EXPECT_NEAR(dot(axis, axis), 1, 1e-12);
  EXPECT_NEAR(dot(frame.x, frame.y), 0, 1e-12);
  EXPECT_NEAR(dot(frame.y, frame.z), 0, 1e-12);
  EXPECT_NEAR(dot(frame.z, frame.x), 0, 1e-12);
  const std::array<double, 3> cross{frame.x[1] * frame.y[2] - frame.x[2] * frame.y[1],
                                    frame.x[2] * frame.y[0] - frame.x[0] * frame.y[2],
                                    frame.x[0] * frame.y[1] - frame.x[1] * frame.y[0]};
  EXPECT_NEAR(dot(cross, frame.z), 1, 1e-12);
}

/// A camera over the road: pitch below the horizon, then rolled about its axis. The normal in the camera's frame is
/// (sin ψ·cos θ, cos ψ·cos θ, sin θ).
RoadPlane plane_of(double pitch, double roll, double height_m) {
  return {{std::sin(roll) * std::cos(pitch), std::cos(roll) * std::cos(pitch), std::sin(pitch)}, height_m, pitch};
}

TEST(RoadAxes, AreOrthonormalAndRightHandedWithZUp) {
  for (const double pitch : {90.0, 60.0, 30.0, 4.0, 0.5}) {
    for (const double roll : {0.0, 3.0, -20.0, 80.0}) {
      const RoadPlane plane = plane_of(pitch * degree, roll * degree, 1.6);
      const RoadFrame frame = road_frame(plane);
      expect_right_handed(frame);
      const auto camera = frame.to_road({0, 0, 0});
      EXPECT_NEAR(camera[0], 0, 1e-12);
      EXPECT_NEAR(camera[1], 0, 1e-12);
      EXPECT_NEAR(camera[2], 1.6, 1e-12) << "the camera stands above the road";
      EXPECT_GT(frame.x[0], 0) << "to the camera's right";
      const std::array<double, 3> ray{0.1, 0.3, 1};
      const double z = plane.height_m / dot(plane.normal, ray);
      EXPECT_NEAR(frame.to_road({z * ray[0], z * ray[1], z})[2], 0, 1e-12);
    }
  }
}

TEST(RoadAxes, NadirAndStreetByHand) {
  const RoadFrame nadir = road_frame(plane_of(90 * degree, 0, 2));
  const auto seen = nadir.to_road({0.3, 0.5, 1.9});  // right of the middle, below it, 10 cm above the road
  EXPECT_NEAR(seen[0], 0.3, 1e-12);
  EXPECT_NEAR(seen[1], -0.5, 1e-12);
  EXPECT_NEAR(seen[2], 0.1, 1e-12);
  const RoadFrame level = road_frame(plane_of(0, 0, 1.5));  // looks at the horizon
  const auto ahead = level.to_road({-2, 1.4, 20});
  EXPECT_NEAR(ahead[0], -2, 1e-12);
  EXPECT_NEAR(ahead[1], 20, 1e-12);
  EXPECT_NEAR(ahead[2], 0.1, 1e-12);
  const RoadFrame slanted = road_frame(plane_of(35 * degree, 0, 1.5));
  const auto axis = slanted.to_road({0, 0, 1.5 / std::sin(35 * degree)});  // where the optical axis meets the road
  EXPECT_NEAR(axis[0], 0, 1e-12);
  EXPECT_NEAR(axis[1], 1.5 / std::tan(35 * degree), 1e-12);
  EXPECT_NEAR(axis[2], 0, 1e-12);
}

TEST(RoadAxes, PointsOfADisparityModelLieOnTheRoad) {
  const RoadPlane plane = road_plane(tilted_road, tilted_rig());
  const RoadFrame frame = road_frame(plane);
  expect_right_handed(frame);
  for (const auto& [u, v] : {std::array{0.0, 0.0}, std::array{299.0, 10.0}, std::array{140.0, 199.0}}) {
    const auto point = frame.to_road(tilted_rig().point_m(u, v, tilted_road.disparity(u, v)));
    EXPECT_NEAR(point[2], 0, 1e-12);
  }
}

}  // namespace
}  // namespace roadstereo
