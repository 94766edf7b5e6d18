#include <cmath>
#include <functional>
#include <limits>

#include "core/parallel.hpp"
#include "roadstereo/synth.hpp"
#include "synth/camera.hpp"
#include "synth/damage_truth.hpp"
#include "synth/degradation.hpp"
#include "synth/hash.hpp"
#include "synth/lens_cover.hpp"
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
  View(const Road& road, const HeightField& field, const Texture& texture)
      : field_(field), texture_(texture), caster_(field, road.boxes) {}

  /// `midpoint_offset_m`: of FootprintModel.
  void set_camera(const Camera& camera, double midpoint_offset_m) {
    camera_ = camera;
    footprints_ = FootprintModel(camera, midpoint_offset_m);
  }

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
    const Vec3 position = ray.at(hit.depth);
    const double lit = hit.box ? texture_.box_grey(*hit.box, position, hit.depth / camera_.focal_px)
                               : road_grey(hit, position, footprints_.at(hit.depth, u, v), ray.direction);
    const double grey = lit * texture_.shade(position.x, position.y);
    const double haze = 1 - std::exp(-hit.depth / haze_m);
    return grey + haze * (sky_grey({0, 1, 0}) - grey);
  }

  double road_grey(const Hit& hit, const Vec3& position, const Footprint& footprint, const Vec3& direction) const {
    SurfacePoint point{
        position.x, position.y, 0, 1, field_.undamaged_slope_x(position.x), field_.undamaged_slope_y(position.y)};
    if (hit.near_damage) add_damage(footprint, point);
    return texture_.wet_grey(texture_.grey(point, footprint), position, direction);
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

using CameraOfRow = std::function<Camera(int row)>;

Image<float> render_irradiance(const Scene& scene, const HeightField& field, const Texture& texture,
                               const CameraOfRow& camera_of, double midpoint_offset_m, int threads) {
  Image<float> irradiance(scene.rig.width, scene.rig.height);
  parallel_rows(scene.rig.height, rows_per_band, threads, [&](int first, int last, int) {
    View view(scene.road, field, texture);
    for (int v = first; v < last; ++v) {
      view.set_camera(camera_of(v), midpoint_offset_m);
      for (int u = 0; u < scene.rig.width; ++u) irradiance(u, v) = view.pixel(u, v, scene.supersampling);
    }
  });
  return irradiance;
}

/// Ground truth of single pixels. Owns a ray caster; use one per thread.
class TruthRenderer {
 public:
  TruthRenderer(const Scene& scene, const HeightField& field)
      : scene_(scene), field_(field), caster_(field, scene.road.boxes) {
    for (const Kerb& kerb : scene.road.kerbs) right_edge_m_ = std::min(right_edge_m_, kerb.x_m);
  }

  void render_row(int v, SyntheticPair& pair) {
    const Rig rig = rig_of_row(scene_, v);
    left_ = left_camera(rig);
    right_ = right_camera(rig, scene_.degradation);
    for (int u = 0; u < scene_.rig.width; ++u) render_pixel(u, v, pair);
  }

 private:
  /// Set disparity, visibility, label and road of a pixel.
  void render_pixel(int u, int v, SyntheticPair& pair) {
    if (is_bonnet(scene_, 0, u, v)) return;
    const Ray ray = left_.ray(u, v);
    const Hit hit = caster_.first_hit(ray, 0);
    if (hit.depth > max_depth_m) return;
    const Vec3 point = ray.at(hit.depth);
    pair.disparity(u, v) = scene_.rig.focal_px * scene_.rig.baseline_m / hit.depth;
    const int id = hit.near_damage ? field_.damage_id(point.x, point.y) : 0;
    const bool is_scenery = id > 0 && static_cast<std::size_t>(id) <= scene_.road.blobs.size() &&
                            !scene_.road.blobs[static_cast<std::size_t>(id - 1)].is_damage;
    if (!is_scenery) pair.labels(u, v) = static_cast<std::uint16_t>(id);
    pair.visible(u, v) = is_visible_from_right(point, hit.depth) ? 255 : 0;
    const bool on_road = hit.box == nullptr && !is_scenery && point.x >= scene_.road.verge_left_m &&
                         point.x <= std::min(scene_.road.verge_right_m, right_edge_m_);
    pair.road(u, v) = on_road ? 255 : 0;
  }

  bool is_visible_from_right(const Vec3& point, double depth) {
    const auto [u, v] = right_.project(point);
    if (u < 0 || u > scene_.rig.width - 1 || v < 0 || v > scene_.rig.height - 1 || is_bonnet(scene_, 1, u, v)) {
      return false;
    }
    return caster_.first_hit(right_.ray(u, v), 0).depth >= depth * (1 - same_point_tolerance);
  }

  const Scene& scene_;
  double right_edge_m_ = no_hit;
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
  pair.road.assign(width, height, 0);
  parallel_rows(height, rows_per_band, threads, [&](int first, int last, int) {
    TruthRenderer renderer(scene, field);
    for (int v = first; v < last; ++v) renderer.render_row(v, pair);
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
  const auto left = [&](int row) { return left_camera(rig_of_row(scene, row)); };
  const auto right = [&](int row) { return right_camera(rig_of_row(scene, row), degradation); };
  Image<float> left_light = render_irradiance(scene, field, texture, left, half_baseline_m, threads);
  Image<float> right_light = render_irradiance(scene, field, texture, right, -half_baseline_m, threads);
  cover_lens(scene, 0, left_light);
  cover_lens(scene, 1, right_light);
  pair.left = simulate_camera(left_light, degradation, 1, noise_key, threads);
  pair.right = simulate_camera(right_light, degradation, 1 + degradation.gain_difference, ~noise_key, threads);
  return pair;
}

}  // namespace roadstereo::synth
