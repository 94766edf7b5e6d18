#include <algorithm>
#include <cmath>

#include "core/cholesky.hpp"
#include "core/order_statistics.hpp"
#include "core/require_size.hpp"
#include "damage/local_ground_plane.hpp"
#include "road/robust_weights.hpp"
#include "roadstereo/pipeline.hpp"
#include "roadstereo/rig_bias.hpp"

namespace roadstereo {
namespace {

constexpr std::size_t field_terms = RigBias::terms;
constexpr std::size_t plane_terms = RigBias::plane_terms;
constexpr std::size_t free_terms = RigBiasFrame::free_terms;
constexpr double smallest_pivot = 1e-10;

Vector<field_terms> powers_at(double x, double y) {
  Vector<field_terms> powers{1, x, y};
  std::size_t before = 1, at = 3;
  for (int degree = 2; degree <= RigBias::max_order; ++degree) {
    for (int i = 0; i < degree; ++i) powers[at++] = x * powers[before + static_cast<std::size_t>(i)];
    powers[at] = y * powers[before + static_cast<std::size_t>(degree) - 1];
    before += static_cast<std::size_t>(degree);
    ++at;
  }
  return powers;
}

/// Weighted mean of the road's residuals in a square of the image. A whole cell counts as one sample.
struct BiasCell {
  Vector<field_terms> powers;
  double residual, weight;
};

/// Cells of a frame and the box of their pixels.
struct BiasCells {
  std::vector<BiasCell> list;
  std::array<double, 4> region_px{HUGE_VAL, HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
};

class CellReader {
 public:
  CellReader(const FrameResult& frame, const DamageMap& damage)
      : frame_(frame), damage_(damage), side_(std::max(min_side, frame.transformed.width() / columns)) {}

  BiasCells read() const {
    BiasCells cells;
    for (int v = 0; v + side_ <= frame_.transformed.height(); v += side_) {
      for (int u = 0; u + side_ <= frame_.transformed.width(); u += side_) add(u, v, cells);
    }
    return cells;
  }

 private:
  static constexpr int columns = 40, min_side = 8, step = 2;

  void add(int first_u, int first_v, BiasCells& cells) const {
    constexpr double min_share = 0.25;
    double count = 0, weight = 0, residual = 0, at_u = 0, at_v = 0;
    for (int v = first_v; v < first_v + side_; v += step) {
      for (int u = first_u; u < first_u + side_; u += step) {
        if (damage_.road(u, v) == 0 || damage_.ids(u, v) != 0) continue;
        const double value = frame_.transformed(u, v) - frame_.delta_t, sigma = frame_.sigma(u, v);
        if (!std::isfinite(value) || !(sigma > 0)) continue;
        const double w = 1 / (sigma * sigma);
        count += 1;
        weight += w;
        residual += w * value;
        at_u += w * u;
        at_v += w * v;
      }
    }
    const int along = (side_ + step - 1) / step;
    const double all = 1.0 * along * along;
    if (count < min_share * all) return;
    const double half = 0.5 * frame_.transformed.width();
    const double x = (at_u / weight - 0.5 * (frame_.transformed.width() - 1)) / half;
    const double y = (at_v / weight - 0.5 * (frame_.transformed.height() - 1)) / half;
    cells.list.push_back({powers_at(x, y), residual / weight, weight / all});
    auto& [u0, v0, u1, v1] = cells.region_px;
    u0 = std::min<double>(u0, first_u);
    v0 = std::min<double>(v0, first_v);
    u1 = std::max<double>(u1, first_u + side_ - 1);
    v1 = std::max<double>(v1, first_v + side_ - 1);
  }

  const FrameResult& frame_;
  const DamageMap& damage_;
  int side_;
};

/// Normal equations of all terms, the lower half of the matrix.
struct BiasEquations {
  Matrix<field_terms> a{};
  Vector<field_terms> b{};

  void add(const BiasCell& cell, double weight) {
    for (std::size_t i = 0; i < field_terms; ++i) {
      const double row = weight * cell.powers[i];
      b[i] += row * cell.residual;
      for (std::size_t j = 0; j <= i; ++j) a[i][j] += row * cell.powers[j];
    }
  }

  Vector<field_terms> solve() const {
    Matrix<field_terms> factor = a;
    factor_in_place(factor, smallest_pivot);
    return solve_factored(factor, b);
  }
};

/// IRLS: the equations with the weights of the last iteration.
BiasEquations robust_equations(const std::vector<BiasCell>& cells) {
  constexpr int iterations = 6;
  std::vector<double> residuals;
  residuals.reserve(cells.size());
  for (const BiasCell& cell : cells) residuals.push_back(cell.residual);
  BiasEquations equations;
  for (int i = 0; i < iterations; ++i) {
    const double scale = std::max(min_scale_px, gaussian_mad * upper_median_magnitude(std::vector(residuals)));
    equations = {};
    for (std::size_t k = 0; k < cells.size(); ++k) {
      equations.add(cells[k], cells[k].weight * tukey_weight(residuals[k] / (tukey * scale)));
    }
    const Vector<field_terms> fit = equations.solve();
    for (std::size_t k = 0; k < cells.size(); ++k) {
      residuals[k] = cells[k].residual;
      for (std::size_t j = 0; j < field_terms; ++j) residuals[k] -= fit[j] * cells[k].powers[j];
    }
  }
  return equations;
}

/// Eliminates the plane of the frame (Schur complement).
void eliminate_plane(const BiasEquations& equations, RigBiasFrame& frame) {
  Matrix<plane_terms> factor{};
  Vector<plane_terms> plane{};
  for (std::size_t i = 0; i < plane_terms; ++i) {
    plane[i] = equations.b[i];
    for (std::size_t j = 0; j <= i; ++j) factor[i][j] = equations.a[i][j];
  }
  factor_in_place(factor, smallest_pivot);
  frame.weight = equations.a[0][0];
  std::size_t element = 0;
  for (std::size_t i = 0; i < free_terms; ++i) {
    const Vector<field_terms>& row = equations.a[plane_terms + i];
    const Vector<plane_terms> of_term = solve_factored(factor, {row[0], row[1], row[2]});
    frame.vector[i] = equations.b[plane_terms + i];
    for (std::size_t k = 0; k < plane_terms; ++k) {
      frame.vector[i] -= of_term[k] * plane[k];
      frame.planes[k * free_terms + i] = frame.weight * of_term[k];
    }
    for (std::size_t j = 0; j <= i; ++j, ++element) {
      frame.matrix[element] = row[plane_terms + j];
      for (std::size_t k = 0; k < plane_terms; ++k)
        frame.matrix[element] -= of_term[k] * equations.a[plane_terms + j][k];
    }
  }
}

}  // namespace

std::optional<RigBiasFrame> measure_rig_bias(const FrameResult& frame, const DamageMap& damage) {
  constexpr std::size_t min_cells = 60;
  if (!frame.roll_found || frame.transformed.empty() || frame.sigma.empty() || damage.road.empty()) return std::nullopt;
  require_same_size(damage, frame.transformed);
  require_same_size("the transformed map", map_size(frame.transformed), "its standard errors", map_size(frame.sigma));
  const BiasCells cells = CellReader(frame, damage).read();
  if (cells.list.size() < min_cells) return std::nullopt;
  RigBiasFrame measured;
  measured.width = frame.transformed.width();
  measured.height = frame.transformed.height();
  measured.region_px = cells.region_px;
  eliminate_plane(robust_equations(cells.list), measured);
  return measured;
}

}  // namespace roadstereo
