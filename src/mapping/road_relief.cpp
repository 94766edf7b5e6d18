#include "roadstereo/road_relief.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include "core/cholesky.hpp"
#include "core/order_statistics.hpp"
#include "core/parallel.hpp"
#include "core/tukey.hpp"

namespace roadstereo {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

constexpr double radius_nodes = 7.5;  ///< of the plane around a node

/// Means of the cells around the nodes of a grid; NaN without a measurement. Row 0 is the one of smallest y.
struct NodeGrid {
  double node_m = 0.1;
  int first_column = 0, first_row = 0;  ///< node (i, j) lies at ((first_column + i)·node_m, …)
  Image<float> height;
};

NodeGrid make_nodes(const RoadMap& map, const MapBox& box) {
  const double cell_m = map.options().cell_m;
  const int margin = static_cast<int>(std::ceil(radius_nodes)) + 1;
  NodeGrid grid;
  const double node_m = grid.node_m = std::max(grid.node_m, cell_m);
  grid.first_column = static_cast<int>(std::floor(box.i0 * cell_m / node_m)) - margin;
  grid.first_row = static_cast<int>(std::floor(box.j0 * cell_m / node_m)) - margin;
  const int columns =
      static_cast<int>(std::ceil((box.i0 + box.columns) * cell_m / node_m)) + margin - grid.first_column;
  const int rows = static_cast<int>(std::ceil((box.j0 + box.rows) * cell_m / node_m)) + margin - grid.first_row;
  const auto cell = [&](double node) { return static_cast<int>(std::floor((node - 0.5) * node_m / cell_m)); };
  const int i0 = cell(grid.first_column), j0 = cell(grid.first_row);
  const MapRaster cells =
      map.read({i0, j0, cell(grid.first_column + columns) - i0 + 1, cell(grid.first_row + rows) - j0 + 1});
  Image<float> count(columns, rows, 0);
  grid.height.assign(columns, rows, 0);
  for (int v = 0; v < cells.box.rows; ++v) {
    const double y = (j0 + cells.box.rows - 1 - v + 0.5) * cell_m;
    const int row = static_cast<int>(std::lround(y / node_m)) - grid.first_row;
    for (int u = 0; u < cells.box.columns; ++u) {
      const int column = static_cast<int>(std::lround((i0 + u + 0.5) * cell_m / node_m)) - grid.first_column;
      if (column < 0 || row < 0 || column >= columns || row >= rows || std::isnan(cells.height(u, v))) continue;
      grid.height(column, row) += cells.height(u, v);
      ++count(column, row);
    }
  }
  for (std::size_t k = 0; k < count.pixels(); ++k) {
    const float n = count.row(0)[k];
    grid.height.row(0)[k] = n > 0 ? grid.height.row(0)[k] / n : nan;
  }
  return grid;
}

/// Height of the robust plane at node (column, row); NaN with too few neighbours.
float reference_at(const NodeGrid& grid, int column, int row) {
  struct Neighbour {
    double x, y, z, residual;
  };
  constexpr int iterations = 4;
  constexpr double smallest = 1e-9, min_scale_m = 1e-4;
  const double node_m = grid.node_m, radius_m = radius_nodes * node_m;
  const int reach = static_cast<int>(radius_nodes);
  std::vector<Neighbour> neighbours;
  for (int j = std::max(0, row - reach); j <= std::min(grid.height.height() - 1, row + reach); ++j) {
    for (int i = std::max(0, column - reach); i <= std::min(grid.height.width() - 1, column + reach); ++i) {
      const double x = (i - column) * node_m, y = (j - row) * node_m;
      if (std::hypot(x, y) <= radius_m && !std::isnan(grid.height(i, j)))
        neighbours.push_back({x, y, grid.height(i, j), 0});
    }
  }
  const double possible = std::numbers::pi * radius_nodes * radius_nodes;
  if (static_cast<double>(neighbours.size()) < possible / 5) return nan;
  std::vector<double> heights;
  heights.reserve(neighbours.size());
  for (const Neighbour& n : neighbours) heights.push_back(n.z);
  const double median = upper_median(heights);
  for (Neighbour& n : neighbours) n.residual = n.z - median;
  double height = median;
  for (int k = 0; k < iterations; ++k) {
    std::vector<double> magnitudes;
    magnitudes.reserve(neighbours.size());
    for (const Neighbour& n : neighbours) magnitudes.push_back(std::abs(n.residual));
    const double limit = tukey * std::max(gaussian_mad * upper_median(magnitudes), min_scale_m);
    Matrix<3> matrix{};
    Vector<3> right{};
    for (const Neighbour& n : neighbours) {
      const double w = tukey_weight(n.residual / limit);
      const Vector<3> terms{1, n.x, n.y};
      for (std::size_t a = 0; a < 3; ++a) {
        right[a] += w * terms[a] * n.z;
        for (std::size_t b = 0; b <= a; ++b) matrix[a][b] += w * terms[a] * terms[b];
      }
    }
    const std::optional<Vector<3>> plane = solve_positive_definite(matrix, right, smallest);
    if (!plane) return nan;
    height = (*plane)[0];
    for (Neighbour& n : neighbours) n.residual = n.z - (*plane)[0] - (*plane)[1] * n.x - (*plane)[2] * n.y;
  }
  return static_cast<float>(height);
}

}  // namespace

MapRaster read_relief(const RoadMap& map, const MapBox& box) {
  MapRaster raster = map.read(box);
  const bool empty = std::all_of(raster.views.row(0), raster.views.row(0) + raster.views.pixels(),
                                 [](std::uint16_t views) { return views == 0; });
  if (empty) return raster;
  const NodeGrid grid = make_nodes(map, box);
  Image<float> reference(grid.height.width(), grid.height.height());
  parallel_rows(reference.height(), 1, map.options().threads, [&](int first, int last, int) {
    for (int row = first; row < last; ++row) {
      for (int column = 0; column < reference.width(); ++column)
        reference(column, row) = reference_at(grid, column, row);
    }
  });
  const double cell_m = map.options().cell_m, node_m = grid.node_m;
  for (int v = 0; v < box.rows; ++v) {
    const double y = (box.j0 + box.rows - 1 - v + 0.5) * cell_m / node_m - grid.first_row;
    const int row = static_cast<int>(y);
    const auto up = static_cast<float>(y - row);
    for (int u = 0; u < box.columns; ++u) {
      const double x = (box.i0 + u + 0.5) * cell_m / node_m - grid.first_column;
      const int column = static_cast<int>(x);
      const auto along = static_cast<float>(x - column);
      const float below = reference(column, row) + along * (reference(column + 1, row) - reference(column, row));
      const float above =
          reference(column, row + 1) + along * (reference(column + 1, row + 1) - reference(column, row + 1));
      raster.height(u, v) -= below + up * (above - below);
    }
  }
  return raster;
}

}  // namespace roadstereo
