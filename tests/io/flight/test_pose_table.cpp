// Smoothed poses of simulated frames.

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <sstream>

#include "roadstereo/io/pose_table.hpp"

namespace roadstereo::io {
namespace {

std::vector<std::vector<std::string>> rows_of(const std::string& csv) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream lines(csv);
  for (std::string line; std::getline(lines, line);) {
    line.pop_back();  // CR
    std::istringstream cells(line + ",");
    rows.emplace_back();
    for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(cell);
  }
  return rows;
}

/// The roll passes the wall of ±90° steadily; the height is 2 m, measured to 10 mm.
TEST(PoseTable, SmoothsAcrossTheWrapOfRoll) {
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  PoseTable table;
  constexpr int count = 200;
  const auto true_roll_deg = [](int k) { return 80 + 0.1 * k; };  // 80 … 100
  for (int k = 0; k < count; ++k) {
    FlightFrame frame;
    frame.index = k;
    frame.time_s = k / 30.0;
    const double roll_deg = true_roll_deg(k) + 0.2 * normal(random);
    frame.roll_rad = (roll_deg > 90 ? roll_deg - 180 : roll_deg) * 0.017453292519943295;
    frame.roll_stderr_rad = 0.2 * 0.017453292519943295;
    frame.roll_observable = k != 50;
    frame.height_m = 2 + 0.01 * normal(random);
    table.add(frame);
  }
  const auto rows = rows_of(table.csv());
  ASSERT_EQ(rows.size(), count + 1U);
  EXPECT_EQ(rows[0][2], "roll_deg");
  EXPECT_EQ(rows[51][2], "") << "the roll of frame 50 is not observable";
  EXPECT_EQ(rows[1][4], "") << "there is no pitch without a calibration";
  for (const int k : {0, 99, 100, 101, 199}) {
    const std::vector<std::string>& row = rows[static_cast<std::size_t>(k) + 1];
    EXPECT_NEAR(std::remainder(std::stod(row[2]) - true_roll_deg(k), 180), 0, 0.1) << k;
    EXPECT_LE(std::abs(std::stod(row[2])), 90) << k;
    EXPECT_LT(std::stod(row[3]), 0.2);
    EXPECT_NEAR(std::stod(row[6]), 2, 0.004) << k;
    EXPECT_LT(std::stod(row[7]), 0.004);
  }
}

TEST(PoseTable, NumbersStandForUnknownTimes) {
  PoseTable table;
  for (int k = 0; k < 10; ++k) {
    FlightFrame frame;
    frame.index = k;
    frame.height_m = 2 + 0.1 * k;
    table.add(frame);
  }
  const auto rows = rows_of(table.csv());
  EXPECT_EQ(rows[5][1], "");
  EXPECT_NEAR(std::stod(rows[5][6]), 2.4, 1e-6);
}

}  // namespace
}  // namespace roadstereo::io
