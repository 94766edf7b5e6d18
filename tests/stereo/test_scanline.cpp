// Paths along a row against the minimum over every path there is, on every instruction set that this machine has.

#include <gtest/gtest.h>
#include <hwy/aligned_allocator.h>
#include <hwy/highway.h>
#include <hwy/targets.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "stereo/coarse/scanline.hpp"
#include "tests/core/every_target.hpp"
#include "tests/stereo/textured_pair.hpp"

namespace roadstereo {
namespace {

using ScanlineTarget = test::EveryTarget;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr double uncorrelated_cost = 0.75;

/// One row: cost[u][d] without priors, and what optimise_scanlines is told besides.
struct Row {
  std::vector<std::vector<float>> cost;
  std::vector<float> centre, weight, truncation;
  ScanlinePenalties penalties{0.2F, 0.7F};
  int first_seen = 0;

  int columns() const { return static_cast<int>(cost.size()); }
  int disparities() const { return static_cast<int>(cost.front().size()); }
};

/// Random costs, and priors of which one in four is missing when there are any.
Row random_row(int columns, int disparities, bool guessed, std::uint64_t seed) {
  Row row;
  for (int u = 0; u < columns; ++u) {
    auto& cost = row.cost.emplace_back();
    for (int d = 0; d < disparities; ++d) cost.push_back(static_cast<float>(test::lattice(u, d, seed)));
    const double prior = test::lattice(u, -1, seed) * disparities;
    const bool missing = !guessed || test::lattice(u, -2, seed) < 0.25;
    row.centre.push_back(missing ? nan : static_cast<float>(prior));
    row.weight.push_back(static_cast<float>(0.4 * test::lattice(u, -3, seed)));
    row.truncation.push_back(static_cast<float>(4 * test::lattice(u, -4, seed)));
  }
  return row;
}

/// The cost of pixel u at disparity d: texture where there is a counterpart, and the prior.
double pixel_cost(const Row& row, int u, int d) {
  const auto column = static_cast<std::size_t>(u);
  const double seen = d <= u - row.first_seen ? row.cost[column][static_cast<std::size_t>(d)] : uncorrelated_cost;
  if (std::isnan(row.centre[column])) return seen;
  const double away = std::min(std::abs(d - double{row.centre[column]}), double{row.truncation[column]});
  return seen + double{row.weight[column]} * away * away;
}

double change_cost(const Row& row, int from, int to) {
  if (from == to) return 0;
  const double jump = row.penalties.jump;
  return std::abs(from - to) == 1 ? std::min(double{row.penalties.step}, jump) : jump;
}

using Totals = std::vector<std::vector<double>>;  ///< [u][d]: cost of the cheapest path through disparity d of column u

Totals no_totals(const Row& row) {
  constexpr double infinite_cost = std::numeric_limits<double>::infinity();
  return Totals(row.cost.size(), std::vector<double>(row.cost.front().size(), infinite_cost));
}

/// By trying all paths.
Totals of_all_paths(const Row& row) {
  Totals totals = no_totals(row);
  std::vector<int> path(row.cost.size(), 0);
  for (bool more = true; more;) {
    double sum = 0;
    for (int u = 0; u < row.columns(); ++u) {
      const auto column = static_cast<std::size_t>(u);
      sum += pixel_cost(row, u, path[column]);
      if (u > 0) sum += change_cost(row, path[column - 1], path[column]);
    }
    for (std::size_t u = 0; u < path.size(); ++u) {
      double& total = totals[u][static_cast<std::size_t>(path[u])];
      total = std::min(total, sum);
    }
    more = false;
    for (int& d : path) {
      more = ++d < row.disparities();
      if (more) break;
      d = 0;
    }
  }
  return totals;
}

/// By the shortest way between all pairs of disparities of neighbouring columns, for rows with too many paths to try.
Totals of_shortest_paths(const Row& row) {
  const int last = row.columns() - 1;
  Totals from_left = no_totals(row), from_right = no_totals(row), totals = no_totals(row);
  for (int step = 0; step <= last; ++step) {
    for (int d = 0; d < row.disparities(); ++d) {
      const auto relax = [&](Totals& path_cost, int u, int neighbour) {
        double& best = path_cost[static_cast<std::size_t>(u)][static_cast<std::size_t>(d)];
        if (step == 0) best = 0;
        for (int e = 0; e < row.disparities() && step > 0; ++e) {
          const double before = path_cost[static_cast<std::size_t>(neighbour)][static_cast<std::size_t>(e)];
          best = std::min(best, before + change_cost(row, e, d));
        }
        best += pixel_cost(row, u, d);
      };
      relax(from_left, step, step - 1);
      relax(from_right, last - step, last - step + 1);
    }
  }
  for (std::size_t u = 0; u < totals.size(); ++u) {
    for (std::size_t d = 0; d < totals[u].size(); ++d) {
      totals[u][d] = from_left[u][d] + from_right[u][d] - pixel_cost(row, static_cast<int>(u), static_cast<int>(d));
    }
  }
  return totals;
}

/// A row with its memory, which beside the guards is full of what must not matter.
struct RowInMemory {
  explicit RowInMemory(const Row& of) : row(of), disparity(of.cost.size()) {
    constexpr std::ptrdiff_t grid = 16;
    pitch = (row.disparities() + grid - 1) / grid * grid;
    const std::size_t size = scanline_scratch(row.columns(), pitch);
    costs = hwy::AllocateAligned<float>(static_cast<std::size_t>(row.columns() * pitch));
    scratch = hwy::AllocateAligned<float>(size);
    std::fill_n(scratch.get(), size, -1000.0F);
    guard_scanline_scratch(row.columns(), pitch, row.disparities(), scratch.get());
  }
  Scanline scanline() {
    for (int u = 0; u < row.columns(); ++u) {
      const std::vector<float>& cost = row.cost[static_cast<std::size_t>(u)];
      std::fill_n(costs.get() + u * pitch, pitch, -1000.0F);
      std::copy(cost.begin(), cost.end(), costs.get() + u * pitch);
    }
    return {{costs.get(), pitch, row.columns(), row.disparities(), row.first_seen},
            {row.centre.data(), row.weight.data(), row.truncation.data()},
            scratch.get(),
            disparity.data()};
  }

  const Row& row;
  std::ptrdiff_t pitch;
  hwy::AlignedFreeUniquePtr<float[]> costs, scratch;
  std::vector<float> disparity;
};

void expect_same(const std::vector<float>& a, const std::vector<float>& b) {
  EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(float)), 0);
}

/// The disparities that optimise_scanlines takes: alone, and the same bits beside a row of any other content.
std::vector<float> taken(const Row& row) {
  const auto cost = static_cast<float>(uncorrelated_cost);
  Row reversed = row;
  std::reverse(reversed.cost.begin(), reversed.cost.end());
  RowInMemory own(row), other(reversed);
  const Scanline alone = own.scanline();
  optimise_scanlines(&alone, 1, row.penalties, cost);
  std::vector<float> disparity = own.disparity;
  const Scanline other_alone = other.scanline();
  optimise_scanlines(&other_alone, 1, row.penalties, cost);
  const std::vector<float> of_other = other.disparity;
  const Scanline both[] = {own.scanline(), other.scanline()};
  optimise_scanlines(both, 2, row.penalties, cost);
  expect_same(own.disparity, disparity);
  expect_same(other.disparity, of_other);
  return disparity;
}

/// Beside the road: the vertex of the pixel's own costs, of variance 2c/K, and the road, of variance 1/(2w).
double fraction_near_road(const Row& row, std::size_t u, std::size_t d) {
  const std::vector<float>& cost = row.cost[u];
  const double before = cost[d - 1], at = cost[d], after = cost[d + 1], second = before + after - 2 * at;
  const double block = second > 0 ? second / (2 * std::max(at, 0.02)) : 0, road = 2 * double{row.weight[u]};
  const double vertex = second > 0 ? std::clamp((before - after) / (2 * second), -1.0, 1.0) : 0;
  const double offset = double{row.centre[u]} - static_cast<double>(d);
  return std::clamp((block * vertex + road * offset) / (block + (road > 0 ? road : 1)), -0.5, 0.5);
}

/// The winner among the disparities with a counterpart, with the vertex of the parabola through its neighbours.
double winner(const Row& row, const std::vector<double>& totals, int u) {
  const auto count = static_cast<std::ptrdiff_t>(std::min(row.disparities(), u - row.first_seen + 1));
  if (count <= 0) return std::numeric_limits<double>::quiet_NaN();
  const auto best = std::min_element(totals.begin(), totals.begin() + count);
  const auto d = best - totals.begin();
  if (d == 0 || d + 1 >= count) return static_cast<double>(d);
  const auto column = static_cast<std::size_t>(u);
  if (std::abs(double{row.centre[column]} - static_cast<double>(d)) <= 1) {
    return static_cast<double>(d) + fraction_near_road(row, column, static_cast<std::size_t>(d));
  }
  return static_cast<double>(d) + (best[-1] - best[1]) / (2 * (best[-1] + best[1] - 2 * *best));
}

void expect_cheapest(const Row& row, const Totals& totals) {
  const std::vector<float> found = taken(row);
  for (int u = 0; u < row.columns(); ++u) {
    const auto column = static_cast<std::size_t>(u);
    const double expected = winner(row, totals[column], u);
    if (std::isnan(expected)) {
      EXPECT_TRUE(std::isnan(found[column])) << u;
    } else {
      EXPECT_NEAR(found[column], expected, 1e-3) << u;
    }
  }
}

TEST_P(ScanlineTarget, FindsCheapestOfAllPaths) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE(seed);
    Row row = random_row(6, 5, seed % 2 == 0, seed);
    row.first_seen = seed > 3 ? 2 : -20;
    const Totals totals = of_all_paths(row);
    expect_cheapest(row, totals);
    const Totals shortest = of_shortest_paths(row);  // holds where there are too many paths to try
    for (std::size_t u = 0; u < totals.size(); ++u) {
      for (std::size_t d = 0; d < totals[u].size(); ++d) ASSERT_NEAR(totals[u][d], shortest[u][d], 1e-12);
    }
  }
}

TEST_P(ScanlineTarget, FindsCheapestPathForEveryNumberOfDisparities) {
  for (const int disparities : {1, 2, 4, 8, 12, 15, 16, 17, 20, 24, 33}) {
    for (const bool guessed : {false, true}) {
      for (const int first_seen : {-100, 0, 7, 60}) {
        SCOPED_TRACE(testing::Message() << disparities << " disparities, guessed " << guessed << ", from "
                                        << first_seen);
        Row row = random_row(45, disparities, guessed, static_cast<std::uint64_t>(disparities));
        row.first_seen = first_seen;
        expect_cheapest(row, of_shortest_paths(row));
      }
    }
  }
}

TEST_P(ScanlineTarget, WithoutPenaltiesColumnsAreIndependent) {
  Row row = random_row(20, 24, false, 5);
  row.penalties = {0, 0};
  row.first_seen = -100;
  Totals alone = no_totals(row);
  for (std::size_t u = 0; u < alone.size(); ++u) std::copy(row.cost[u].begin(), row.cost[u].end(), alone[u].begin());
  expect_cheapest(row, alone);
}

TEST_P(ScanlineTarget, HandlesSingleColumn) {
  Row row = random_row(1, 9, true, 2);
  row.first_seen = -100;
  expect_cheapest(row, of_all_paths(row));
}

INSTANTIATE_TEST_SUITE_P(Machine, ScanlineTarget, testing::ValuesIn(test::targets_of_this_machine()),
                         test::name_of_target);

}  // namespace
}  // namespace roadstereo
