#include "damage/road_undulation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace roadstereo {
namespace {

constexpr int max_cells = 64;  ///< of the grid in either direction

/// Variance of the difference of heights `distance` metres apart on an average road, class C of ISO 8608: its power
/// spectral density falls with the square of the frequency from 256e-6 m³ at 0.1 per metre, as that of a random walk.
double step_variance(double distance) {
  constexpr double density = 256e-6, frequency = 0.1;
  return 2 * std::numbers::pi * std::numbers::pi * density * frequency * frequency * distance;
}

/// Symmetric equations of a grid of nodes: of each node its own coefficient and those of the four neighbours that
/// follow it.
class GridEquations {
 public:
  GridEquations(int columns, int rows) : matrix_(columns, rows), right_side_(columns, rows, 0) {}

  int columns() const { return matrix_.width(); }
  int rows() const { return matrix_.height(); }
  const Image<double>& right_side() const { return right_side_; }

  /// Add w·(s·h − v)² for a place between four nodes of heights h with the shares s: `square` is w, `value` w·v.
  void add(int column, int row, const std::array<double, 4>& share, double square, double value) {
    Node *const low = matrix_.row(row) + column, *const high = low + matrix_.width();
    const auto product = [&](std::size_t a, std::size_t b) { return square * share[a] * share[b]; };
    low[0].own += product(0, 0);
    low[0].right += product(0, 1);
    low[0].up += product(0, 2);
    low[0].up_right += product(0, 3);
    low[1].own += product(1, 1);
    low[1].up_left += product(1, 2);
    low[1].up += product(1, 3);
    high[0].own += product(2, 2);
    high[0].right += product(2, 3);
    high[1].own += product(3, 3);
    double *const below = right_side_.row(row) + column, *const above = below + right_side_.width();
    below[0] += value * share[0];
    below[1] += value * share[1];
    above[0] += value * share[2];
    above[1] += value * share[3];
  }
  /// Add w·h² for a node.
  void add_height(int column, int row, double weight) { matrix_(column, row).own += weight; }
  /// Add w·(h − h')² for a node and the one after it in its row or in its column.
  void add_step_right(int column, int row, double weight) {
    add_height(column, row, weight);
    add_height(column + 1, row, weight);
    matrix_(column, row).right -= weight;
  }
  void add_step_up(int column, int row, double weight) {
    add_height(column, row, weight);
    add_height(column, row + 1, weight);
    matrix_(column, row).up -= weight;
  }

  /// A vector divided by the diagonal of the matrix.
  void precondition(const Image<double>& in, Image<double>& out) const {
    for (std::size_t k = 0; k < in.pixels(); ++k) out.row(0)[k] = in.row(0)[k] / matrix_.row(0)[k].own;
  }

  /// Product of the matrix and a vector.
  void multiply(const Image<double>& in, Image<double>& out) const {
    std::fill_n(out.row(0), out.pixels(), 0.0);
    for (int j = 0; j < rows(); ++j) {
      for (int i = 0; i < columns(); ++i) {
        const Node& node = matrix_(i, j);
        double sum = node.own * in(i, j);
        const auto couple = [&](int column, int row, double coefficient) {
          sum += coefficient * in(column, row);
          out(column, row) += coefficient * in(i, j);
        };
        const bool has_right = i + 1 < columns(), has_up = j + 1 < rows();
        if (has_right) couple(i + 1, j, node.right);
        if (has_up) couple(i, j + 1, node.up);
        if (has_up && i > 0) couple(i - 1, j + 1, node.up_left);
        if (has_up && has_right) couple(i + 1, j + 1, node.up_right);
        out(i, j) += sum;
      }
    }
  }

 private:
  struct Node {
    double own = 0, right = 0, up_left = 0, up = 0, up_right = 0;
  };

  Image<Node> matrix_;
  Image<double> right_side_;
};

/// Prior of the heights: steps from node to node of that variance, and heights as after a random walk over the grid.
GridEquations prior_equations(int columns, int rows, double variance) {
  GridEquations equations(columns, rows);
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      equations.add_height(i, j, 1 / (max_cells * variance));
      if (i + 1 < columns) equations.add_step_right(i, j, 1 / variance);
      if (j + 1 < rows) equations.add_step_up(i, j, 1 / variance);
    }
  }
  return equations;
}

double dot(const Image<double>& a, const Image<double>& b) {
  double sum = 0;
  for (std::size_t k = 0; k < a.pixels(); ++k) sum += a.row(0)[k] * b.row(0)[k];
  return sum;
}

/// a += factor·b
void add_multiple(double factor, const Image<double>& b, Image<double>& a) {
  for (std::size_t k = 0; k < a.pixels(); ++k) a.row(0)[k] += factor * b.row(0)[k];
}

/// Conjugate gradients from `heights` on. Jacobi's preconditioner: nodes far away, where a metre of height is a few
/// pixels of disparity, have coefficients a hundred times smaller than near ones, and would stay unsolved without it.
void solve(const GridEquations& equations, Image<float>& heights) {
  constexpr int max_iterations = 60;
  constexpr double tolerance = 1e-3;  // of the right side, both preconditioned
  Image<double> solution(heights.width(), heights.height());
  std::copy_n(heights.row(0), heights.pixels(), solution.row(0));
  Image<double> residual = equations.right_side(), product = residual;
  equations.multiply(solution, product);
  add_multiple(-1, product, residual);
  Image<double> scaled = equations.right_side();
  equations.precondition(equations.right_side(), scaled);
  const double enough = tolerance * tolerance * dot(equations.right_side(), scaled);
  equations.precondition(residual, scaled);
  Image<double> direction = scaled;
  double energy = dot(residual, scaled);
  for (int k = 0; k < max_iterations && energy > enough; ++k) {
    equations.multiply(direction, product);
    const double step = energy / dot(direction, product);
    add_multiple(step, direction, solution);
    add_multiple(-step, product, residual);
    equations.precondition(residual, scaled);
    const double next = dot(residual, scaled);
    for (std::size_t n = 0; n < direction.pixels(); ++n) {
      direction.row(0)[n] = scaled.row(0)[n] + next / energy * direction.row(0)[n];
    }
    energy = next;
  }
  std::transform(solution.row(0), solution.row(0) + solution.pixels(), heights.row(0),
                 [](double height) { return static_cast<float>(height); });
}

}  // namespace

RoadUndulation::RoadUndulation(std::span<const double> x, std::span<const double> y) {
  const auto [left, right] = std::minmax_element(x.begin(), x.end());
  const auto [near, far] = std::minmax_element(y.begin(), y.end());
  const double width = *right - *left, length = *far - *near;
  spacing_m_ = std::max(straightedge_m / 2, std::max(width, length) / max_cells);
  const auto cells = [this](double extent) { return std::max(1, static_cast<int>(std::ceil(extent / spacing_m_))); };
  const int columns = cells(width), rows = cells(length);
  if (columns == 1 && rows == 1) return;
  first_x_ = static_cast<float>(*left - 0.5 * (columns * spacing_m_ - width));
  first_y_ = static_cast<float>(*near - 0.5 * (rows * spacing_m_ - length));
  per_metre_ = static_cast<float>(1 / spacing_m_);
  heights_.assign(columns + 1, rows + 1, 0);
  places_.reserve(x.size());
  for (std::size_t k = 0; k < x.size(); ++k) {
    places_.push_back(place(static_cast<float>(x[k]), static_cast<float>(y[k])));
  }
}

void RoadUndulation::add_to(const float* x, const float* y, const float* scale, int count, float* values) const {
  constexpr int max_places = 64;  // found together: the loop is vectorised, unlike that which looks up their nodes
  std::array<int, max_places> columns, rows;
  std::array<float, max_places> right, up;
  for (int first = 0; first < count; first += max_places) {
    const auto places = static_cast<std::size_t>(std::min(max_places, count - first));
    for (std::size_t k = 0; k < places; ++k) {
      const Place at = place(x[k], y[k]);
      columns[k] = at.column;
      rows[k] = at.row;
      right[k] = at.right;
      up[k] = at.up;
    }
    for (std::size_t k = 0; k < places; ++k) values[k] += scale[k] * height({columns[k], rows[k], right[k], up[k]});
    x += places;
    y += places;
    scale += places;
    values += places;
  }
}

void RoadUndulation::fit(std::span<const double> scale, std::span<const double> value, std::span<const double> weight) {
  GridEquations equations = prior_equations(heights_.width(), heights_.height(), step_variance(spacing_m_));
  for (std::size_t k = 0; k < places_.size(); ++k) {
    if (weight[k] == 0) continue;
    const Place& at = places_[k];
    const double right = at.right, up = at.up, left = 1 - right, down = 1 - up;
    const double ws = weight[k] * scale[k];
    equations.add(at.column, at.row, {left * down, right * down, left * up, right * up}, ws * scale[k], ws * value[k]);
  }
  solve(equations, heights_);
}

}  // namespace roadstereo
