#include <algorithm>
#include <cmath>

#include "core/cholesky.hpp"
#include "core/require_range.hpp"
#include "roadstereo/rig_bias.hpp"

namespace roadstereo {
namespace {

constexpr std::size_t plane_terms = RigBias::plane_terms;
constexpr std::size_t free_terms = RigBiasFrame::free_terms;
constexpr double smallest_pivot = 1e-10;

/// Number of free terms of the degrees 2 … order.
constexpr std::size_t terms_up_to(int order) {
  return static_cast<std::size_t>((order + 1) * (order + 2) / 2) - plane_terms;
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
