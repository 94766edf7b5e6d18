#include "road/plane_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/order_statistics.hpp"
#include "road/random_number.hpp"

namespace roadstereo {

void PlaneSums::add(const PlaneSums& other) {
  s_.n += other.s_.n;
  s_.u += other.s_.u;
  s_.v += other.s_.v;
  s_.d += other.s_.d;
  s_.uu += other.s_.uu;
  s_.uv += other.s_.uv;
  s_.vv += other.s_.vv;
  s_.ud += other.s_.ud;
  s_.vd += other.s_.vd;
  s_.dd += other.s_.dd;
}

std::optional<DisparityPlane> PlaneSums::plane(bool with_roll) const {
  DisparityPlane model;
  if (!solve_slopes({s_.n, uu(), uv(), vv(), ud(), vd()}, with_roll, model.a1, model.a2)) return std::nullopt;
  model.a0 = mean_d() - model.a1 * mean_v() - model.a2 * mean_u();
  return model;
}

std::optional<IrlsPlaneFit> fit_plane_irls(std::span<const DisparityPoint> points, const DisparityPlane& start,
                                           double start_scale_px, bool with_roll, int max_iterations) {
  if (points.size() < 3) return std::nullopt;
  IrlsPlaneFit fit{start, start_scale_px, 0, scratch_vector<double>(points.size())};
  auto residuals = scratch_vector<double>(points.size());
  const auto measure_from = [&](const DisparityPlane& plane) {
    for (std::size_t i = 0; i < points.size(); ++i)
      residuals[i] = points[i].d - plane.disparity(points[i].u, points[i].v);
  };
  auto near = scratch_vector<double>();
  near.reserve(points.size());
  measure_from(start);
  while (fit.iterations < max_iterations) {
    ++fit.iterations;
    PlaneSums sums(points.front().u, points.front().v);
    for (std::size_t i = 0; i < points.size(); ++i) {
      fit.weights[i] = tukey_weight(residuals[i] / (tukey * fit.scale_px));
      if (fit.weights[i] > 0) sums.add(points[i], fit.weights[i]);
    }
    const std::optional<DisparityPlane> plane = sums.plane(with_roll);
    if (!plane) return std::nullopt;
    // The scale comes from the residuals in the window that is left, so that it narrows onto the road.
    measure_from(*plane);
    near.clear();
    for (const double residual : residuals) {
      if (std::abs(residual) < tukey * fit.scale_px) near.push_back(residual);
    }
    const double scale = narrowed_scale(upper_median_magnitude(near), fit.scale_px);
    const DisparityPoint& far = points.back();
    const bool settled =
        robust_fit_settled(plane->disparity(far.u, far.v) - fit.plane.disparity(far.u, far.v), plane->a2 - fit.plane.a2,
                           scale, fit.scale_px, static_cast<double>(near.size()));
    fit.plane = *plane;
    fit.scale_px = scale;
    if (settled) break;
  }
  return fit;
}

std::optional<DisparityPlane> plane_through(const DisparityPoint& a, const DisparityPoint& b, const DisparityPoint& c) {
  DisparityPlane plane;
  if (!plane_through({a.u, a.v, a.d}, {b.u, b.v, b.d}, {c.u, c.v, c.d}, plane)) return std::nullopt;
  return plane;
}

namespace {

/// Scores planes by points in groups, and stops where the rest cannot make one the best.
class PreemptiveScorer {
 public:
  PreemptiveScorer(ScratchVector<DisparityPoint> points, double tolerance_px)
      : points_(std::move(points)), tolerance_px_(tolerance_px) {}

  /// Score of the plane; some number up to `least` when it cannot be higher.
  double score(const DisparityPlane& plane, double least) const {
    double sum = 0;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      if (i % group == 0 && sum + static_cast<double>(points_.size() - i) <= least) break;  // a point adds at most 1
      const double x = (points_[i].d - plane.disparity(points_[i].u, points_[i].v)) / tolerance_px_;
      sum += std::max(0.0, 1 - x * x);
    }
    return sum;
  }

 private:
  static constexpr std::size_t group = 25;

  ScratchVector<DisparityPoint> points_;
  double tolerance_px_;
};

}  // namespace

std::optional<DisparityPlane> ransac_plane(std::span<const DisparityPoint> points, double tolerance_px) {
  constexpr int iterations = 300;
  constexpr std::size_t samples = 400;
  if (points.size() < 3) return std::nullopt;
  Sampler sampler;
  const auto draw = [&]() -> const DisparityPoint& { return points[sampler.below(points.size())]; };
  auto drawn = scratch_vector<DisparityPoint>();
  drawn.reserve(samples);
  for (std::size_t i = 0; i < samples; ++i) drawn.push_back(draw());
  const PreemptiveScorer scorer(std::move(drawn), tolerance_px);
  std::optional<DisparityPlane> best;
  double best_score = 0;
  for (int i = 0; i < iterations; ++i) {
    const DisparityPoint &a = draw(), &b = draw(), &c = draw();
    const auto plane = plane_through(a, b, c);
    if (!plane) continue;
    const double score = scorer.score(*plane, best_score);
    if (score > best_score) {
      best_score = score;
      best = plane;
    }
  }
  return best;
}

namespace {

/// The points that planes are compared by, in single precision: their residuals from the start, which are small.
class ComparedPoints {
 public:
  ComparedPoints(std::span<const DisparityPoint> points, const DisparityPlane& start) : start_(start) {
    const auto count = static_cast<int>(points.size());
    for (int k = 0; count > 0 && k < compared_points; ++k) {
      const DisparityPoint& point = points[static_cast<std::size_t>(compared_point(k, count))];
      if (std::isnan(point.d)) continue;
      u_[count_] = static_cast<float>(point.u);
      v_[count_] = static_cast<float>(point.v);
      from_start_[count_++] = static_cast<float>(point.d - start.disparity(point.u, point.v));
    }
  }
  bool empty() const { return count_ == 0; }

  /// Whether the quantile of a plane is less than `limit`. Vectorises.
  bool has_quantile_below(const DisparityPlane& plane, float limit) const {
    const Step step(start_, plane);
    int near = 0, below = 0;
    for (std::size_t k = 0; k < count_; ++k) {
      const float residual = from_start_[k] - step.at(u_[k], v_[k]);
      const int is_below = residual < 0 ? 1 : 0;
      below += is_below;
      near += std::abs(residual) < limit ? 1 + is_below : 0;
    }
    return near >= quantile_of(static_cast<int>(count_), below);
  }

  float quantile(const DisparityPlane& plane) const {
    const Step step(start_, plane);
    std::array<float, compared_points> residuals;
    for (std::size_t k = 0; k < count_; ++k) residuals[k] = from_start_[k] - step.at(u_[k], v_[k]);
    const auto end = residuals.begin() + static_cast<std::ptrdiff_t>(count_);
    const auto below = std::count_if(residuals.begin(), end, [](float r) { return r < 0; });
    std::sort(residuals.begin(), end, [](float a, float b) { return std::abs(a) < std::abs(b); });
    int left = quantile_of(static_cast<int>(count_), static_cast<int>(below));
    const auto at =
        std::find_if(residuals.begin(), end, [&](float r) { return (left -= quantile_weight(r < 0)) <= 0; });
    return std::abs(at == end ? *(end - 1) : *at);
  }

 private:
  /// Difference of a plane and the start.
  struct Step {
    float a0, a1, a2;
    Step(const DisparityPlane& start, const DisparityPlane& plane)
        : a0(static_cast<float>(plane.a0 - start.a0)),
          a1(static_cast<float>(plane.a1 - start.a1)),
          a2(static_cast<float>(plane.a2 - start.a2)) {}
    float at(float u, float v) const { return a0 + a1 * v + a2 * u; }
  };

  DisparityPlane start_;
  std::size_t count_ = 0;
  std::array<float, compared_points> u_, v_, from_start_;
};

}  // namespace

QuantilePlane least_quantile_plane(std::span<const DisparityPoint> points, const DisparityPlane& start) {
  const ComparedPoints compared(points, start);
  if (compared.empty()) return {start, 0};
  DisparityPlane best = start;
  float least = compared.quantile(start);
  const auto count = static_cast<int>(points.size());
  for (int k = 0; k < tried_planes; ++k) {
    const auto corner = [&](int of_plane) -> const DisparityPoint& {
      return points[static_cast<std::size_t>(corner_point(k, of_plane, count))];
    };
    const DisparityPoint &a = corner(0), &b = corner(1), &c = corner(2);
    if (std::isnan(a.d + b.d + c.d)) continue;
    const auto plane = plane_through(a, b, c);
    if (!plane || !compared.has_quantile_below(*plane, least)) continue;
    best = *plane;
    least = compared.quantile(best);
  }
  return {best, least};
}

}  // namespace roadstereo
