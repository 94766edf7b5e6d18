#include "odometry/patch_matching.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "core/order_statistics.hpp"
#include "core/parabola.hpp"
#include "core/tukey.hpp"
#include "odometry/direct_alignment.hpp"
#include "odometry/warped_patch.hpp"

namespace roadstereo {
namespace {

constexpr double min_depth_m = 0.05;
constexpr std::size_t min_patches = 15;

/// Pixel at which the current camera sees a point of the reference, and how pixels around it are displaced.
struct Projection {
  Vector<3> point{};  ///< camera frame, metres
  double u = 0, v = 0;
  std::array<double, 4> jacobian{1, 0, 0, 1};  ///< of (u, v) by the pixel of the reference, row-major
  bool valid = false;
};

class Projector {
 public:
  Projector(const StereoCalibration& calibration, const RigidMotion& motion, double offset_px)
      : calibration_(calibration), motion_(motion), offset_px_(offset_px) {}

  Vector<3> point(const ReferencePoint& at, double du = 0, double dv = 0) const {
    const double disparity = at.disparity + at.slope_u * du + at.slope_v * dv;
    const double offset = offset_px_ * offset_shape(calibration_, at.u, disparity);
    return calibration_.point_m(at.u + du, at.v + dv, disparity + offset);
  }

  Projection project(const Vector<3>& p) const {
    Projection seen;
    seen.point = motion_(p);
    if (!(p[2] > 0 && seen.point[2] > min_depth_m)) return seen;
    seen.u = calibration_.focal_px * seen.point[0] / seen.point[2] + calibration_.cx_px;
    seen.v = calibration_.focal_px * seen.point[1] / seen.point[2] + calibration_.cy_px;
    seen.valid = true;
    return seen;
  }

  Projection project_patch(const ReferencePoint& at) const {
    Projection seen = project(point(at));
    const Projection right = project(point(at, 1, 0)), below = project(point(at, 0, 1));
    seen.jacobian = {right.u - seen.u, below.u - seen.u, right.v - seen.v, below.v - seen.v};
    seen.valid = seen.valid && right.valid && below.valid;
    return seen;
  }

 private:
  const StereoCalibration& calibration_;
  const RigidMotion& motion_;
  double offset_px_;
};

/// Where a patch was found, pixels of the image.
struct Match {
  const TexturePatch* patch = nullptr;
  Vector<3> point{};
  double u = 0, v = 0;
};

class Search {
 public:
  Search(ImageView<const std::int16_t> image, int level, int radius)
      : image_(image),
        scale_(1 << level),
        radius_(radius),
        ncc_(static_cast<std::size_t>((2 * radius + 3) * (2 * radius + 3))) {}

  /// False when the best position is outside, at the border of the search, or agrees too little.
  bool find(const WarpedPatch& patch, double& u, double& v) {
    constexpr float min_ncc = 0.7F;
    constexpr int margin = WarpedPatch::radius;
    const int u0 = static_cast<int>(std::lround((u + 0.5) / scale_ - 0.5)),
              v0 = static_cast<int>(std::lround((v + 0.5) / scale_ - 0.5));
    const int far = radius_ + 1 + margin;
    if (u0 < far || v0 < far || u0 + far >= image_.width() || v0 + far >= image_.height()) return false;
    const int side = 2 * radius_ + 1;
    int best_x = 0, best_y = 0;
    float best = min_ncc;
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        const float ncc = patch.correlate(image_, u0 + x - radius_, v0 + y - radius_);
        at(x, y) = ncc;
        if (ncc <= best) continue;
        best = ncc;
        best_x = x;
        best_y = y;
      }
    }
    if (best_x == 0 || best_y == 0 || best_x == side - 1 || best_y == side - 1) return false;
    if (!unique(best_x, best_y, best)) return false;
    const double dx = vertex(at(best_x - 1, best_y), best, at(best_x + 1, best_y));
    const double dy = vertex(at(best_x, best_y - 1), best, at(best_x, best_y + 1));
    u = (u0 + best_x - radius_ + dx + 0.5) * scale_ - 0.5;
    v = (v0 + best_y - radius_ + dy + 0.5) * scale_ - 0.5;
    return true;
  }

 private:
  float& at(int x, int y) {
    return ncc_[static_cast<std::size_t>(y) * (2 * static_cast<std::size_t>(radius_) + 1) +
                static_cast<std::size_t>(x)];
  }

  /// Whether no other position agrees nearly as well: structures repeat.
  bool unique(int best_x, int best_y, float best) {
    constexpr float max_second = 0.9F;  // of the maximum
    constexpr int peak = 2;             // pixels from the maximum to its foot
    const int side = 2 * radius_ + 1;
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        if (std::max(std::abs(x - best_x), std::abs(y - best_y)) > peak && at(x, y) > max_second * best) return false;
      }
    }
    return true;
  }

  /// Maximum of the parabola through three values, −½ … ½.
  static double vertex(double before, double middle, double after) {
    return second_difference(before, middle, after) < 0 ? std::clamp(parabola_vertex(before, middle, after), -0.5, 0.5)
                                                        : 0;
  }

  ImageView<const std::int16_t> image_;
  int scale_;
  int radius_;
  std::vector<float> ncc_;
};

/// Error of a match in the metric of its structure tensor, pixels.
double error_of(const TexturePatch& patch, double eu, double ev) {
  return std::sqrt(std::max(patch.uu * eu * eu + 2 * patch.uv * eu * ev + patch.vv * ev * ev, 0.0));
}

/// Robust Gauss–Newton on the reprojection errors. The scale of the weights shrinks from one that accepts nearly all
/// matches (graduated non-convexity): most points are far and hardly move, and the near ones, which tell the
/// translation, must not be outliers of a first guess.
RigidMotion solve_motion(const std::vector<Match>& matches, const StereoCalibration& calibration,
                         const RigidMotion& start, double min_scale_px) {
  constexpr int iterations = 12;
  constexpr double narrowing = 0.6;
  RigidMotion motion = start;
  std::vector<double> errors, magnitudes;
  double widest = 0;
  const double f = calibration.focal_px;
  for (int i = 0; i < iterations; ++i) {
    errors.clear();
    const Projector projector(calibration, motion, 0);
    for (const Match& match : matches) {
      const Projection seen = projector.project(match.point);
      errors.push_back(seen.valid ? error_of(*match.patch, seen.u - match.u, seen.v - match.v) : INFINITY);
    }
    magnitudes = errors;
    if (i == 0) widest = lower_quantile(magnitudes, 0.9);
    const double narrowest = std::max(gaussian_mad * upper_median_magnitude(magnitudes), min_scale_px);
    const double scale = std::max(narrowest, widest);
    widest *= narrowing;
    Matrix<6> normal{};
    Vector<6> right{};
    for (std::size_t k = 0; k < matches.size(); ++k) {
      const double weight = tukey_weight(errors[k] / (tukey * scale));
      if (weight == 0) continue;
      const Projection seen = projector.project(matches[k].point);
      const Vector<3>& q = seen.point;
      const Vector<3> du{f / q[2], 0, -f * q[0] / (q[2] * q[2])}, dv{0, f / q[2], -f * q[1] / (q[2] * q[2])};
      const Vector<3> ru = cross(q, du), rv = cross(q, dv);
      const Vector<6> ju{du[0], du[1], du[2], ru[0], ru[1], ru[2]}, jv{dv[0], dv[1], dv[2], rv[0], rv[1], rv[2]};
      const TexturePatch& patch = *matches[k].patch;
      const double eu = seen.u - matches[k].u, ev = seen.v - matches[k].v;
      const double gu = weight * (patch.uu * eu + patch.uv * ev), gv = weight * (patch.uv * eu + patch.vv * ev);
      for (std::size_t a = 0; a < 6; ++a) {
        right[a] -= ju[a] * gu + jv[a] * gv;
        for (std::size_t b = 0; b <= a; ++b) {
          normal[a][b] += weight * (patch.uu * ju[a] * ju[b] + patch.uv * (ju[a] * jv[b] + jv[a] * ju[b]) +
                                    patch.vv * jv[a] * jv[b]);
        }
      }
    }
    constexpr double smallest = 1e-9;
    factor_in_place(normal, smallest);
    motion = rigid_motion(solve_factored(normal, right)) * motion;
  }
  return motion;
}

}  // namespace

RigidMotion match_patches(const ReferencePoints& reference, const LinkMaps& current,
                          const StereoCalibration& calibration, const RigidMotion& start, double offset_px, int level,
                          int radius) {
  Search search(current.pyramid.level(level), level, radius);
  const Projector projector(calibration, start, offset_px);
  std::vector<Match> matches;
  WarpedPatch warped;
  for (const TexturePatch& patch : reference.patches[static_cast<std::size_t>(level - 1)]) {
    const Projection seen = projector.project_patch(patch.point);
    if (!seen.valid || !warped.warp(patch, seen.jacobian)) continue;
    Match match{&patch, projector.point(patch.point), seen.u, seen.v};
    if (search.find(warped, match.u, match.v)) matches.push_back(match);
  }
  if (matches.size() < min_patches) return start;
  const double min_scale_px = 0.2 * (1 << level);
  return solve_motion(matches, calibration, start, min_scale_px);
}

double patch_correlation(const ReferencePoints& reference, const LinkMaps& current,
                         const StereoCalibration& calibration, const RigidMotion& motion, double offset_px) {
  constexpr int level = 1;
  if (current.pyramid.levels() <= level) return 0;
  ImageView<const std::int16_t> image = current.pyramid.level(level);
  constexpr int radius = WarpedPatch::radius;
  const Projector projector(calibration, motion, offset_px);
  WarpedPatch warped;
  std::vector<std::pair<double, double>> found;  // disparity, NCC
  for (const TexturePatch& patch : reference.patches[0]) {
    const Projection seen = projector.project_patch(patch.point);
    if (!seen.valid || !warped.warp(patch, seen.jacobian)) continue;
    const int u = static_cast<int>(std::lround((seen.u + 0.5) / 2 - 0.5));
    const int v = static_cast<int>(std::lround((seen.v + 0.5) / 2 - 0.5));
    if (u < radius || v < radius || u + radius >= image.width() || v + radius >= image.height()) continue;
    const float ncc = warped.correlate(image, u, v);
    if (ncc > -1) found.emplace_back(patch.point.disparity, static_cast<double>(ncc));
  }
  if (found.size() < 2 * min_patches) return 0;
  const auto middle = found.begin() + static_cast<std::ptrdiff_t>(found.size() / 2);
  std::nth_element(found.begin(), middle, found.end());
  const auto median = [](auto first, auto last) {
    std::vector<double> values;
    for (; first != last; ++first) values.push_back(first->second);
    return central_median(values);
  };
  return std::min(median(found.begin(), middle), median(middle, found.end()));
}

}  // namespace roadstereo
