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
/// Maximum depth of the road; farther road is rendered as sky. It lies within a pixel of the horizon and would alias.
constexpr double max_depth_m = 1000;
/// Distance at which haze reduces the contrast by a factor of e.
constexpr double haze_m = 300;
/// Relative tolerance of depths in the images; the ground truth is accurate to floating-point precision.
constexpr double image_tolerance = 1e-6;
/// Relative tolerance between the depths of one point seen from both cameras.
constexpr double same_point_tolerance = 1e-7;

/// Renderer of one camera. Owns a ray caster; use one per thread.
class View {
 public:
  View(const HeightField& field, const Texture& texture, const Camera& camera, double midpoint_offset_m)
      : field_(field), texture_(texture), camera_(camera), footprints_(camera, midpoint_offset_m), caster_(field) {}

  /// Irradiance of a pixel: the mean over samples × samples rays, 8-bit grey levels.
  float pixel(int u, int v, int samples) {
    double sum = 0;
    for (int j = 0; j < samples; ++j) {
      for (int i = 0; i < samples; ++i) {
        sum += radiance(u + (i + 0.5) / samples - 0.5, v + (j + 0.5) / samples - 0.5);
      }
    }
    return static_cast<float>(sum / (samples * samples));
  }

 private:
  /// Radiance along one ray.
  double radiance(double u, double v) {
    const Ray ray = camera_.ray(u, v);
    const Hit hit = caster_.first_hit(ray, image_tolerance);
    if (hit.depth > max_depth_m) return sky_grey(ray.direction);
    const Footprint footprint = footprints_.at(hit.depth, u, v);
    const Vec3 position = ray.at(hit.depth);
    SurfacePoint point{position.x, position.y, 0, 1, field_.undamaged_slope(position.x), 0};
    if (hit.near_damage) add_damage(footprint, point);
    const double haze = 1 - std::exp(-hit.depth / haze_m);
    const double grey = texture_.grey(point, footprint);
    return grey + haze * (sky_grey({0, 1, 0}) - grey);
  }

  void add_damage(const Footprint& footprint, SurfacePoint& point) const {
    const DamageSample here = caster_.damage_near_last_ray(point.x, point.y);
    point.offset = here.offset;
    point.light = here.light;
    // Central differences over half of a pixel footprint: finer detail is averaged out.
    const double step = std::max(2e-4, 0.25 * std::min(footprint.x, footprint.y));
    const auto offset = [&](double dx, double dy) {
      return caster_.damage_near_last_ray(point.x + dx, point.y + dy).offset;
    };
    point.slope_x += (offset(step, 0) - offset(-step, 0)) / (2 * step);
    point.slope_y += (offset(0, step) - offset(0, -step)) / (2 * step);
  }

  const HeightField& field_;
  const Texture& texture_;
  Camera camera_;
  FootprintModel footprints_;
  RayCaster caster_;
};

Image<float> render_irradiance(const Scene& scene, const HeightField& field, const Texture& texture,
                               const Camera& camera, double midpoint_offset_m, int threads) {
  Image<float> irradiance(scene.rig.width, scene.rig.height);
  parallel_rows(scene.rig.height, rows_per_band, threads, [&](int first, int last, int) {
    View view(field, texture, camera, midpoint_offset_m);
    for (int v = first; v < last; ++v) {
      for (int u = 0; u < scene.rig.width; ++u) irradiance(u, v) = view.pixel(u, v, scene.supersampling);
    }
  });
  return irradiance;
}

/// Ground truth of single pixels. Owns a ray caster; use one per thread.
class TruthRenderer {
 public:
  TruthRenderer(const Scene& scene, const HeightField& field)
      : rig_(scene.rig),
        row_offset_(scene.degradation.row_offset_px),
        field_(field),
        caster_(field),
        left_(left_camera(scene.rig)),
        right_(right_camera(scene.rig, scene.degradation.row_offset_px)) {}

  /// Set disparity, visibility and label of a pixel.
  void render_pixel(int u, int v, SyntheticPair& pair) {
    const Ray ray = left_.ray(u, v);
    const Hit hit = caster_.first_hit(ray, 0);
    if (hit.depth > max_depth_m) return;
    const double disparity = rig_.focal_px * rig_.baseline_m / hit.depth;
    pair.disparity(u, v) = disparity;
    if (hit.near_damage) {
      const Vec3 point = ray.at(hit.depth);
      pair.labels(u, v) = static_cast<std::uint16_t>(field_.damage_id(point.x, point.y));
    }
    pair.visible(u, v) = is_visible_from_right(u - disparity, v + row_offset_, hit.depth) ? 255 : 0;
  }

 private:
  bool is_visible_from_right(double u, double v, double depth) {
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

void render_truth(const Scene& scene, const HeightField& field, int threads, SyntheticPair& pair) {
  const int width = scene.rig.width;
  const int height = scene.rig.height;
  pair.disparity.assign(width, height, std::numeric_limits<double>::quiet_NaN());
  pair.visible.assign(width, height, 0);
  pair.labels.assign(width, height, 0);
  parallel_rows(height, rows_per_band, threads, [&](int first, int last, int) {
    TruthRenderer renderer(scene, field);
    for (int v = first; v < last; ++v) {
      for (int u = 0; u < width; ++u) renderer.render_pixel(u, v, pair);
    }
  });
}

}  // namespace

SyntheticPair render(const Scene& scene, int threads) {
  scene.validate();
  const HeightField field(scene.road);
  const Texture texture(scene.road, field);
  const Degradation& degradation = scene.degradation;
  const std::uint64_t noise_key = mix64(degradation.noise_seed);

  SyntheticPair pair;
  pair.calibration = scene.rig.calibration();
  pair.plane = road_disparity_plane(scene.rig);
  pair.roll_rad = roll_angle(pair.plane);
  pair.damages = measure_damages(field, scene.road, threads);
  render_truth(scene, field, threads, pair);
  const double half_baseline_m = scene.rig.baseline_m / 2;
  const Camera left = left_camera(scene.rig);
  const Camera right = right_camera(scene.rig, degradation.row_offset_px);
  Image<float> left_light = render_irradiance(scene, field, texture, left, half_baseline_m, threads);
  Image<float> right_light = render_irradiance(scene, field, texture, right, -half_baseline_m, threads);
  pair.left = simulate_camera(left_light, degradation, 1, noise_key, threads);
  pair.right = simulate_camera(right_light, degradation, 1 + degradation.gain_difference, ~noise_key, threads);
  return pair;
}

}  // namespace roadstereo::synth
