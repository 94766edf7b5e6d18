#include <algorithm>
#include <cmath>

#include "core/cholesky.hpp"
#include "core/order_statistics.hpp"
#include "core/require_range.hpp"
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

/// Number of free terms of the degrees 2 … order.
constexpr std::size_t terms_up_to(int order) {
  return static_cast<std::size_t>((order + 1) * (order + 2) / 2) - plane_terms;
}

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

template <class List>
void add_to(List& sum, const List& more) {
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += more[i];
}

void add_to(RigBiasFrame& sum, const RigBiasFrame& more) {
  add_to(sum.region_px, more.region_px);
  sum.weight += more.weight;
  add_to(sum.matrix, more.matrix);
  add_to(sum.vector, more.vector);
  add_to(sum.planes, more.planes);
}

/// Sums of pairs of successive batches; the last one takes a batch that is left over.
std::vector<RigBiasFrame> joined_pairs(const std::vector<RigBiasFrame>& batches) {
  std::vector<RigBiasFrame> pairs;
  for (std::size_t i = 0; i < batches.size(); ++i) {
    if (i % 2 == 0 && i + 1 < batches.size()) {
      pairs.push_back(batches[i]);
    } else {
      add_to(pairs.back(), batches[i]);
    }
  }
  return pairs;
}

RigBiasFrame sum_of(const std::vector<RigBiasFrame>& batches) {
  RigBiasFrame sum = batches.front();
  for (std::size_t i = 1; i < batches.size(); ++i) add_to(sum, batches[i]);
  return sum;
}

/// The matrix of the terms of the degrees 2 … order, the rest 0.
Matrix<free_terms> matrix_of(const RigBiasFrame& batch, std::size_t used) {
  Matrix<free_terms> matrix{};
  std::size_t element = 0;
  for (std::size_t i = 0; i < used; ++i) {
    for (std::size_t j = 0; j <= i; ++j, ++element) matrix[i][j] = matrix[j][i] = batch.matrix[element];
  }
  return matrix;
}

Vector<free_terms> product(const Matrix<free_terms>& matrix, const Vector<free_terms>& vector) {
  Vector<free_terms> result{};
  for (std::size_t i = 0; i < free_terms; ++i) {
    for (std::size_t j = 0; j < free_terms; ++j) result[i] += matrix[i][j] * vector[j];
  }
  return result;
}

double dot(const Vector<free_terms>& a, const Vector<free_terms>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < free_terms; ++i) sum += a[i] * b[i];
  return sum;
}

/// Least-squares field of one order, with the errors that batches of frames show.
class FieldFit {
 public:
  FieldFit(const std::vector<RigBiasFrame>& batches, int order)
      : used_(terms_up_to(order)), sum_(sum_of(batches)), matrix_(matrix_of(sum_, used_)), factor_(matrix_) {
    factor_in_place(factor_, smallest_pivot);
    Vector<free_terms> right{};
    std::copy_n(sum_.vector.begin(), used_, right.begin());
    value_ = solve_factored(factor_, right);
    find_covariance(batches);
  }

  /// Largest coefficient of the degree in its standard errors.
  double significance(int order) const {
    double largest = 0;
    for (std::size_t i = terms_up_to(order - 1); i < used_; ++i) {
      if (covariance_[i][i] > 0) largest = std::max(largest, std::abs(value_[i]) / std::sqrt(covariance_[i][i]));
    }
    return largest;
  }

  void fill(RigBias& field) const {
    for (std::size_t i = 0; i < used_; ++i) {
      field.value_px[plane_terms + i] = value_[i];
      field.std_error_px[plane_terms + i] = std::sqrt(covariance_[i][i]);
      for (std::size_t k = 0; k < plane_terms; ++k) {
        field.value_px[k] -= sum_.planes[k * free_terms + i] * value_[i] / sum_.weight;
      }
    }
    Vector<free_terms> slope = product(matrix_, value_);
    field.rms_px = std::sqrt(dot(value_, slope) / sum_.weight);
    for (double& one : slope) one /= field.rms_px * sum_.weight;
    field.rms_std_error_px = std::sqrt(dot(slope, product(covariance_, slope)));
    field.region_px = sum_.region_px;
    for (double& side : field.region_px) side /= field.frames;
  }

 private:
  /// Of the lengths of batches the one with the largest errors.
  void find_covariance(const std::vector<RigBiasFrame>& batches) {
    constexpr std::size_t min_batches = 8;
    double largest = -1;
    for (std::vector<RigBiasFrame> joined = batches; joined.size() >= min_batches; joined = joined_pairs(joined)) {
      Matrix<free_terms> covariance{};
      const double size = add_scatter(joined, covariance);
      if (size <= largest) continue;
      largest = size;
      covariance_ = covariance;
    }
  }

  /// Σ h hᵀ n / (n − 1) with h = S⁻¹ (s − S c) of each batch. Returns Σ hᵀ S h n / (n − 1).
  double add_scatter(const std::vector<RigBiasFrame>& batches, Matrix<free_terms>& covariance) const {
    const auto n = static_cast<double>(batches.size());
    double size = 0;
    for (const RigBiasFrame& batch : batches) {
      Vector<free_terms> score = product(matrix_of(batch, used_), value_);
      for (std::size_t i = 0; i < used_; ++i) score[i] = batch.vector[i] - score[i];
      const Vector<free_terms> by = solve_factored(factor_, score);
      size += dot(by, score) * n / (n - 1);
      for (std::size_t i = 0; i < free_terms; ++i) {
        for (std::size_t j = 0; j < free_terms; ++j) covariance[i][j] += by[i] * by[j] * n / (n - 1);
      }
    }
    return size;
  }

  std::size_t used_;
  RigBiasFrame sum_;
  Matrix<free_terms> matrix_, factor_;
  Vector<free_terms> value_{};
  Matrix<free_terms> covariance_{};
};

}  // namespace

void RigBiasOptions::validate() const {
  constexpr double max_std_errors = 100;
  constexpr int fewest = 16, most = 1'000'000;
  require_range("rig_bias", "max_order", max_order, 2, RigBias::max_order);
  require_range("rig_bias", "min_std_errors", min_std_errors, 1.0, max_std_errors);
  require_range("rig_bias", "min_frames", min_frames, fewest, most);
}

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

RigBiasEstimator::RigBiasEstimator(const RigBiasOptions& options) : options_(options) {
  options_.validate();
}

void RigBiasEstimator::add(const RigBiasFrame& frame) {
  constexpr std::size_t max_batches = 64;
  if (frames_ > 0 && (frame.width != batches_[0].width || frame.height != batches_[0].height)) return;
  ++frames_;
  if (!batches_.empty() && last_frames_ < batch_frames_) {
    add_to(batches_.back(), frame);
    ++last_frames_;
    return;
  }
  if (batches_.size() == max_batches) {
    batches_ = joined_pairs(batches_);
    batch_frames_ *= 2;
  }
  batches_.push_back(frame);
  last_frames_ = 1;
}

RigBias RigBiasEstimator::estimate(const std::optional<StereoCalibration>& calibration) const {
  RigBias field;
  field.frames = frames_;
  if (frames_ > 0) {
    field.width = batches_[0].width;
    field.height = batches_[0].height;
  }
  if (calibration) field.focal_px = calibration->focal_px;
  if (frames_ < options_.min_frames) return field;
  for (int order = options_.max_order; order >= 2; --order) {
    const FieldFit fit(batches_, order);
    if (fit.significance(order) < options_.min_std_errors) continue;
    field.order = order;
    fit.fill(field);
    break;
  }
  return field;
}

}  // namespace roadstereo
