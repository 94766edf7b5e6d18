#include "road/plane_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/order_statistics.hpp"
#include "road/sampler.hpp"

namespace roadstereo {

void PlaneSums::add(const DisparityPoint& point, double weight) {
  const double u = point.u - origin_u_;
  const double v = point.v - origin_v_;
  s_.n += weight;
  s_.u += weight * u;
  s_.v += weight * v;
  s_.d += weight * point.d;
  s_.uu += weight * u * u;
  s_.uv += weight * u * v;
  s_.vv += weight * v * v;
  s_.ud += weight * u * point.d;
  s_.vd += weight * v * point.d;
  s_.dd += weight * point.d * point.d;
}

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
  auto near = scratch_vector<double>();
  near.reserve(points.size());
  for (fit.iterations = 1; fit.iterations <= max_iterations; ++fit.iterations) {
    PlaneSums sums(points.front().u, points.front().v);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const DisparityPoint& p = points[i];
      fit.weights[i] = tukey_weight((p.d - fit.plane.disparity(p.u, p.v)) / (tukey * fit.scale_px));
      if (fit.weights[i] > 0) sums.add(p, fit.weights[i]);
    }
    const std::optional<DisparityPlane> plane = sums.plane(with_roll);
    if (!plane) return std::nullopt;
    // The scale comes from the residuals in the window that is left, so that it narrows onto the road.
    near.clear();
    for (const DisparityPoint& p : points) {
      const double residual = p.d - plane->disparity(p.u, p.v);
      if (std::abs(residual) < tukey * fit.scale_px) near.push_back(residual);
    }
    const double scale = narrowed_scale(upper_median_magnitude(near), fit.scale_px);
    const DisparityPoint& far = points.back();
    const bool settled = robust_fit_settled(plane->disparity(far.u, far.v) - fit.plane.disparity(far.u, far.v),
                                            plane->a2 - fit.plane.a2, scale, fit.scale_px);
    fit.plane = *plane;
    fit.scale_px = scale;
    if (settled) break;
  }
  return fit;
}

std::optional<DisparityPlane> plane_through(const DisparityPoint& a, const DisparityPoint& b, const DisparityPoint& c) {
  const double bu = b.u - a.u, bv = b.v - a.v, bd = b.d - a.d;
  const double cu = c.u - a.u, cv = c.v - a.v, cd = c.d - a.d;
  const double determinant = bu * cv - bv * cu;
  if (std::abs(determinant) < 1e-6) return std::nullopt;
  DisparityPlane model;
  model.a2 = (bd * cv - bv * cd) / determinant;
  model.a1 = (bu * cd - bd * cu) / determinant;
  model.a0 = a.d - model.a1 * a.v - model.a2 * a.u;
  return model;
}

namespace {

/// Points drawn to judge planes, in groups, and the most that those behind a group can add.
class PreemptiveScorer {
 public:
  PreemptiveScorer(PlaneScore votes, ScratchVector<DisparityPoint> points) : votes_(votes), points_(std::move(points)) {
    double rest = 0;
    for (std::size_t group = groups; group-- > 0;) {
      rest_[group] = rest;
      for (const DisparityPoint& p : of_group(group)) rest += votes_({&p, 1}, DisparityPlane{p.d, 0, 0});
    }
  }

  /// All votes for the plane; some smaller number than `least` when there cannot be as many.
  double judge(const DisparityPlane& plane, double least) const {
    double score = 0;
    for (std::size_t group = 0; group < groups; ++group) {
      score += votes_(of_group(group), plane);
      if (score + rest_[group] < least) break;
    }
    return score;
  }

 private:
  static constexpr std::size_t groups = 16;

  std::span<const DisparityPoint> of_group(std::size_t group) const {
    const std::size_t first = group * points_.size() / groups, last = (group + 1) * points_.size() / groups;
    return std::span(points_).subspan(first, last - first);
  }

  PlaneScore votes_;
  ScratchVector<DisparityPoint> points_;
  std::array<double, groups> rest_{};
};

}  // namespace

std::optional<DisparityPlane> ransac_plane(std::span<const DisparityPoint> points, PlaneScore votes,
                                           FunctionRef<bool(const DisparityPlane&)> possible) {
  constexpr int trials = 300;
  constexpr std::size_t voters = 400;
  if (points.size() < 3) return std::nullopt;
  Sampler sampler;
  const auto draw = [&]() -> const DisparityPoint& { return points[sampler.below(points.size())]; };
  auto drawn = scratch_vector<DisparityPoint>();
  drawn.reserve(voters);
  for (std::size_t i = 0; i < voters; ++i) drawn.push_back(draw());
  const PreemptiveScorer jury(votes, std::move(drawn));
  std::optional<DisparityPlane> best;
  double best_score = 0;
  for (int trial = 0; trial < trials; ++trial) {
    const DisparityPoint &a = draw(), &b = draw(), &c = draw();
    const auto plane = plane_through(a, b, c);
    if (!plane || !possible(*plane)) continue;
    const double score = jury.judge(*plane, best_score);
    if (score > best_score) {
      best_score = score;
      best = plane;
    }
  }
  return best;
}

std::optional<DisparityPlane> ransac_plane(std::span<const DisparityPoint> points, double tolerance_px) {
  const auto votes = [tolerance_px](std::span<const DisparityPoint> voters, const DisparityPlane& plane) {
    double sum = 0;
    for (const DisparityPoint& p : voters) {
      const double x = (p.d - plane.disparity(p.u, p.v)) / tolerance_px;
      sum += std::max(0.0, 1 - x * x);
    }
    return sum;
  };
  return ransac_plane(points, votes, [](const DisparityPlane&) { return true; });
}

}  // namespace roadstereo
