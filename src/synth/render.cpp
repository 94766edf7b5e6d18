#include <cmath>
#include <limits>

#include "core/parallel.hpp"
#include "roadstereo/synth.hpp"
#include "synth/camera.hpp"
#include "synth/damage_truth.hpp"
#include "synth/degradation.hpp"
#include "synth/hash.hpp"
#include "synth/ray_caster.hpp"
#include "synth/texture.hpp"

namespace roadstereo::synth {
namespace {

constexpr int rows_per_band = 4;
/// Farther road is sky: it lies within a pixel of the horizon, and it would only alias.
constexpr double farthest_m = 1000;
/// Distance at which haze has taken 63 percent of the contrast.
constexpr double haze_m = 300;
/// Relative exactness of depths in the pictures; that of the truth is as good as the numbers allow.
constexpr double picture_tolerance = 1e-6;
/// Two depths of one surface point, seen from both cameras, agree to this.
constexpr double same_point_tolerance = 1e-7;

/// The world as one camera sees it. One per thread, for it owns a ray caster.
class View {
 public:
  View(const HeightField& field, const Texture& texture, const Camera& camera, double to_middle_m)
      : field_(field), texture_(texture), camera_(camera), footprints_(camera, to_middle_m), caster_(field) {}

  /// Light on the pixel: the mean over samples × samples rays.
  float pixel(int u, int v, int samples) {
    double sum = 0;
    for (int j = 0; j < samples; ++j) {
      for (int i = 0; i < samples; ++i) {
        sum += light(u + (i + 0.5) / samples - 0.5, v + (j + 0.5) / samples - 0.5);
      }
    }
    return static_cast<float>(sum / (samples * samples));
  }

 private:
  double light(double u, double v) {
    const Ray ray = camera_.ray(u, v);
    const Hit hit = caster_.first_hit(ray, picture_tolerance);
    if (hit.depth > farthest_m) return sky_grey(ray.direction);
    const Footprint footprint = footprints_.at(hit.depth, u, v);
    const Vec3 place = ray.at(hit.depth);
    SurfacePoint point{place.x, place.y, 0, 1, field_.undamaged_slope(place.x), 0};
    if (hit.near_damage) add_damage(footprint, point);
    const double haze = 1 - std::exp(-hit.depth / haze_m);
    const double grey = texture_.grey(point, footprint);
    return grey + haze * (sky_grey({0, 1, 0}) - grey);
  }

  void add_damage(const Footprint& footprint, SurfacePoint& point) const {
    const DamageSample here = caster_.damage_near_last_ray(point.x, point.y);
    point.offset = here.offset;
    point.light = here.light;
    // Slopes over a part of a pixel: what happens within it is averaged anyway.
    const double reach = std::max(2e-4, 0.25 * std::min(footprint.x, footprint.y));
    const auto offset = [&](double dx, double dy) {
      return caster_.damage_near_last_ray(point.x + dx, point.y + dy).offset;
    };
    point.slope_x += (offset(reach, 0) - offset(-reach, 0)) / (2 * reach);
    point.slope_y += (offset(0, reach) - offset(0, -reach)) / (2 * reach);
  }

  const HeightField& field_;
  const Texture& texture_;
  Camera camera_;
  FootprintModel footprints_;
  RayCaster caster_;
};

Image<float> render_light(const Scene& scene, const HeightField& field, const Texture& texture, const Camera& camera,
                          double to_middle_m, int threads) {
  Image<float> light(scene.rig.width, scene.rig.height);
  parallel_rows(scene.rig.height, rows_per_band, threads, [&](int first, int last, int) {
    View view(field, texture, camera, to_middle_m);
    for (int v = first; v < last; ++v) {
      for (int u = 0; u < scene.rig.width; ++u) light(u, v) = view.pixel(u, v, scene.supersampling);
    }
  });
  return light;
}

/// Fills the truth of single pixels. One per thread.
class TruthFinder {
 public:
  TruthFinder(const Scene& scene, const HeightField& field)
      : rig_(scene.rig),
        row_offset_(scene.degradation.row_offset_px),
        field_(field),
        caster_(field),
        left_(left_camera(scene.rig)),
        right_(right_camera(scene.rig, scene.degradation.row_offset_px)) {}

  void fill(int u, int v, SyntheticPair& pair) {
    const Ray ray = left_.ray(u, v);
    const Hit hit = caster_.first_hit(ray, 0);
    if (hit.depth > farthest_m) return;
    const double disparity = rig_.focal_px * rig_.baseline_m / hit.depth;
    pair.disparity(u, v) = disparity;
    if (hit.near_damage) {
      const Vec3 point = ray.at(hit.depth);
      pair.labels(u, v) = static_cast<std::uint16_t>(field_.damage_id(point.x, point.y));
    }
    pair.visible(u, v) = seen_from_the_right(u - disparity, v + row_offset_, hit.depth) ? 255 : 0;
  }

 private:
  bool seen_from_the_right(double u, double v, double depth) {
    if (u < 0 || u > rig_.width - 1 || v < 0 || v > rig_.height - 1) return false;
    return caster_.first_hit(right_.ray(u, v), 0).depth >= depth * (1 - same_point_tolerance);
  }

  Rig rig_;
  double row_offset_;
  const HeightField& field_;
  RayCaster caster_;
  Camera left_;
  Camera right_;
};

void find_truth(const Scene& scene, const HeightField& field, int threads, SyntheticPair& pair) {
  const int width = scene.rig.width;
  const int height = scene.rig.height;
  pair.disparity.assign(width, height, std::numeric_limits<double>::quiet_NaN());
  pair.visible.assign(width, height, 0);
  pair.labels.assign(width, height, 0);
  parallel_rows(height, rows_per_band, threads, [&](int first, int last, int) {
    TruthFinder finder(scene, field);
    for (int v = first; v < last; ++v) {
      for (int u = 0; u < width; ++u) finder.fill(u, v, pair);
    }
  });
}

}  // namespace

SyntheticPair render(const Scene& scene, int threads) {
  scene.validate();
  const HeightField field(scene.road);
  const Texture texture(scene.road, field);
  const Degradation& wear = scene.degradation;
  const std::uint64_t noise_key = mix64(wear.noise_seed);

  SyntheticPair pair;
  pair.calibration = scene.rig.calibration();
  pair.plane = plane_model(scene.rig);
  pair.roll_rad = paper_roll(pair.plane);
  pair.damages = measure_damages(field, scene.road, threads);
  find_truth(scene, field, threads, pair);
  const double half_way = scene.rig.baseline_m / 2;
  const Camera left_eye = left_camera(scene.rig);
  const Camera right_eye = right_camera(scene.rig, wear.row_offset_px);
  Image<float> left = render_light(scene, field, texture, left_eye, half_way, threads);
  Image<float> right = render_light(scene, field, texture, right_eye, -half_way, threads);
  pair.left = take_picture(left, wear, 1, noise_key, threads);
  pair.right = take_picture(right, wear, 1 + wear.gain_difference, ~noise_key, threads);
  return pair;
}

}  // namespace roadstereo::synth
