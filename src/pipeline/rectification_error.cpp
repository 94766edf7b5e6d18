#include "pipeline/rectification_error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/order_statistics.hpp"
#include "core/tukey.hpp"

namespace roadstereo {
namespace {

constexpr std::size_t terms = RectificationError::terms;

/// Normalised coordinates of a point in both views.
struct ViewPoint {
  double left_x, right_x, y;

  ViewPoint(const RectificationError& lens, double u, double v, double disparity)
      : left_x((u - lens.cx_px) / lens.focal_px),
        right_x((u - disparity - lens.right_cx_px) / lens.focal_px),
        y((v - lens.cy_px) / lens.focal_px) {}

  double left_r2() const { return left_x * left_x + y * y; }
  double right_r2() const { return right_x * right_x + y * y; }
  /// Vertical offset by each term, in focal lengths.
  Vector<terms> row_terms() const { return {1, y, right_x, y * right_r2(), y * (right_r2() - left_r2())}; }
};

struct RowEquations {
  Matrix<terms> a{};
  Vector<terms> b{};

  void add(const Vector<terms>& row, double value, double weight) {
    for (std::size_t i = 0; i < terms; ++i) {
      b[i] += weight * row[i] * value;
      for (std::size_t j = 0; j <= i; ++j) a[i][j] += weight * row[i] * row[j];
    }
  }
};

double predict(const Vector<terms>& value, const Vector<terms>& row) {
  double sum = 0;
  for (std::size_t i = 0; i < terms; ++i) sum += value[i] * row[i];
  return sum;
}

/// Square roots of the diagonal of sigma² a⁻¹.
Vector<terms> std_errors(Matrix<terms> a, double sigma) {
  constexpr double smallest = 1e-12;
  factor_in_place(a, smallest);
  Vector<terms> errors{};
  for (std::size_t i = 0; i < terms; ++i) {
    Vector<terms> unit{};
    unit[i] = 1;
    errors[i] = sigma * std::sqrt(std::max(0.0, solve_factored(a, unit)[i]));
  }
  return errors;
}

}  // namespace

bool RectificationError::is_significant(std::size_t term) const {
  constexpr double min_std_errors = 5;
  return std_error[term] > 0 && std::abs(value[term]) > min_std_errors * std_error[term];
}

double RectificationError::slope_px(double u, double v, double disparity) const {
  const Vector<terms> row = ViewPoint(*this, u, v, disparity).row_terms();
  double sum = 0;
  for (std::size_t i = 1; i < terms; ++i) sum += is_significant(i) ? focal_px * value[i] * row[i] : 0;
  return sum;
}

double RectificationError::disparity_error_px(double u, double v, double disparity) const {
  constexpr std::size_t right = 3, both = 4;
  const ViewPoint at(*this, u, v, disparity);
  double error = 0;
  if (is_significant(right)) error -= value[right] * at.right_x * at.right_r2();
  if (is_significant(both)) error -= value[both] * (at.right_x * at.right_r2() - at.left_x * at.left_r2());
  return focal_px * error;
}

std::optional<RectificationError> fit_rectification_error(const std::vector<RowSample>& samples, int width, int height,
                                                          const std::optional<StereoCalibration>& calibration) {
  constexpr std::size_t min_samples = 20;
  constexpr int iterations = 8;
  constexpr double smallest = 1e-12;
  if (samples.size() < min_samples) return std::nullopt;
  RectificationError fit;
  fit.focal_px = calibration ? calibration->focal_px : width;
  fit.cx_px = calibration ? calibration->cx_px : 0.5 * (width - 1);
  fit.cy_px = calibration ? calibration->cy_px : 0.5 * (height - 1);
  fit.right_cx_px = fit.cx_px + (calibration ? calibration->disparity_offset_px : 0);
  std::vector<double> residuals;
  residuals.reserve(samples.size());
  for (const RowSample& sample : samples) residuals.push_back(sample.dv / fit.focal_px);
  const double median = upper_median(std::vector(residuals));
  for (double& residual : residuals) residual -= median;
  for (int i = 0; i < iterations; ++i) {
    const double sigma = std::max(1e-9, gaussian_mad * upper_median_magnitude(std::vector(residuals)));
    RowEquations equations;
    for (std::size_t k = 0; k < samples.size(); ++k) {
      const RowSample& sample = samples[k];
      equations.add(ViewPoint(fit, sample.u, sample.v, -sample.du).row_terms(), sample.dv / fit.focal_px,
                    tukey_weight(residuals[k] / (tukey * sigma)));
    }
    fit.std_error = std_errors(equations.a, sigma);
    factor_in_place(equations.a, smallest);
    fit.value = solve_factored(equations.a, equations.b);
    for (std::size_t k = 0; k < samples.size(); ++k) {
      const RowSample& sample = samples[k];
      residuals[k] =
          sample.dv / fit.focal_px - predict(fit.value, ViewPoint(fit, sample.u, sample.v, -sample.du).row_terms());
    }
  }
  fit.scatter_px = fit.focal_px * gaussian_mad * upper_median_magnitude(residuals);
  return fit;
}

bool neighbours_agree(const std::vector<RowSample>& samples) {
  std::vector<double> of_neighbours, of_any;
  for (const RowSample& sample : samples) {
    double nearest = std::numeric_limits<double>::infinity(), difference = 0;
    for (const RowSample& other : samples) {
      if (&other == &sample) continue;
      const double distance = std::hypot(other.u - sample.u, other.v - sample.v);
      of_any.push_back(other.dv - sample.dv);
      if (distance >= nearest) continue;
      nearest = distance;
      difference = other.dv - sample.dv;
    }
    of_neighbours.push_back(difference);
  }
  return !of_any.empty() && upper_median_magnitude(of_neighbours) < 0.5 * upper_median_magnitude(of_any);
}

}  // namespace roadstereo
