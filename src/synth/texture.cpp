#include "synth/texture.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "synth/hash.hpp"
#include "synth/noise.hpp"

namespace roadstereo::synth {
namespace {

constexpr double road_grey = 112;

/// Brightness of other ground, relative to the road.
constexpr double pavement_tone = 1.2;
constexpr double kerbstone_tone = 1.5;
constexpr double verge_tone = 0.72;

/// Direction to the sun: to the left, in front of the camera, elevation 45°.
constexpr Vec3 to_sun{-0.5, 0.5, 0.70710678118654752};
constexpr double ambient = 0.45;

/// Wavelengths, in footprints, below which a structure is invisible and above which it has its full contrast.
constexpr double min_wavelength = 1.6;
constexpr double full_wavelength = 3.4;

/// Contrast of a structure of that wavelength in a pixel, 0 … 1.
double resolved(double wavelength, double footprint) {
  return smooth_step((wavelength / footprint - min_wavelength) / (full_wavelength - min_wavelength));
}

/// Bar: 1 for |x| < half_width, 0 outside, with an edge 1.5 pixels wide.
double bar(double x, double half_width, double footprint) {
  const double edge = std::max(1.5 * footprint, 0.002);
  return smooth_step((half_width - std::abs(x)) / edge + 0.5);
}

double distance_to_multiple(double x, double period) {
  return x - period * std::round(x / period);
}

/// Lambertian shading with ambient light; 1 on a level surface.
double lambert(double slope_x, double slope_y) {
  const double towards =
      (to_sun.z - slope_x * to_sun.x - slope_y * to_sun.y) / std::sqrt(1 + slope_x * slope_x + slope_y * slope_y);
  return ambient + (1 - ambient) * std::max(0.0, towards) / to_sun.z;
}

double noise_at(double x, double y, double z, std::uint32_t seed) {
  return z == 0 ? gradient_noise(x, y, seed) : gradient_noise(x, y, z, seed);
}

}  // namespace

Texture::Texture(const Road& road, const HeightField& field)
    : field_(field),
      contrast_(road.texture_contrast),
      lane_marking_(road.lane_marking),
      paint_grey_(road.paint_grey),
      shade_(road.shade),
      wet_share_(road.wet_share),
      verge_left_m_(road.verge_left_m),
      verge_right_m_(road.verge_right_m),
      kerb_x_(no_hit),
      seed_(mix32(road.seed + 0x51ed270bu)) {
  for (const Kerb& kerb : road.kerbs) kerb_x_ = std::min(kerb_x_, kerb.x_m);
}

double Texture::octaves(double x, double y, double z, double footprint, std::uint32_t seed) const {
  // The finest resolved octave is the strongest and coarser octaves decay slowly, so that a window of some pixels has
  // the same contrast at every distance and the road does not look cloudy.
  constexpr double amplitude = 0.078 / gradient_noise_sigma;
  constexpr double decay_per_octave = 0.80;
  constexpr double min_wavelength_m = 0.001;
  constexpr int count = 15;
  constexpr double octaves_used = 6;
  const double finest_octave = std::max(0.0, std::log2(4 * footprint / min_wavelength_m));
  // The lattice is rotated and shifted between octaves to hide its lines.
  constexpr double turn_cosine = 0.8;
  constexpr double turn_sine = 0.6;
  double sum = 0;
  double wavelength = min_wavelength_m;
  double strength = 0;
  double lx = x;
  double ly = y;
  for (int k = 0; k < count; ++k, wavelength *= 2) {
    const double above = k - finest_octave;
    if (above >= octaves_used) break;
    strength = above <= 0 ? 1 : above < 1 ? std::pow(decay_per_octave, above) : strength * decay_per_octave;
    const double next = turn_cosine * lx - turn_sine * ly;
    ly = turn_sine * lx + turn_cosine * ly;
    lx = next;
    const double weight = amplitude * strength * resolved(wavelength, footprint) * std::min(1.0, octaves_used - above);
    if (weight <= 0) continue;
    // One period is two lattice steps.
    const double scale = 2 / wavelength;
    sum += weight * noise_at(lx * scale + 0.37 * k, ly * scale, z * scale, seed + static_cast<std::uint32_t>(k));
  }
  return sum;
}

double Texture::aggregate(double x, double y, double z, const Footprint& footprint) const {
  // Anisotropic filtering: at a grazing angle the footprint of a pixel is elongated, and so is the grain that it
  // resolves, like the streaks that pavers and tyres leave along the road. Four classes of aspect ratio 1, 4, 16, 64.
  const double narrow = std::min(footprint.x, footprint.y);
  const double level = std::clamp(0.5 * std::log2(footprint.y / narrow), 0.0, 3.0);
  const double class_below = std::floor(level);
  // A single class is used for half of the range between two classes, to save time.
  const double blend = smooth_step(2 * (level - class_below) - 0.5);
  double sum = 0;
  for (int i = 0; i < 2; ++i) {
    const double share = i == 0 ? 1 - blend : blend;
    if (share == 0) continue;
    const int stretch_class = static_cast<int>(class_below) + i;
    const double stretch = std::ldexp(1.0, 2 * stretch_class);
    // 0.6 of the stretched length: the rays of a pixel average over the rest.
    const double width = std::max(footprint.x, 0.6 * footprint.y / stretch);
    sum +=
        std::sqrt(share) * octaves(x, y / stretch, z, width, seed_ + 1000u * static_cast<std::uint32_t>(stretch_class));
  }
  return sum;
}

double Texture::stones(double x, double y, double cell, double footprint, std::uint32_t seed) const {
  const double weight = resolved(cell, 2 * footprint);
  if (weight == 0) return 0;
  const double cx = x / cell;
  const double cy = y / cell;
  const double edge = std::max(0.15, 1.5 * footprint / cell);
  // Stones stay near the centre of their cell, so that only the four nearest cells affect a point.
  const double first_x = std::floor(cx - 0.5);
  const double first_y = std::floor(cy - 0.5);
  double sum = 0;
  for (int i = 0; i < 4; ++i) {
    const double ix = first_x + (i & 1);
    const double iy = first_y + (i >> 1);
    const std::uint32_t hash = mix32(static_cast<std::uint32_t>(static_cast<std::int64_t>(ix)) * 0x9e3779b1u +
                                     static_cast<std::uint32_t>(static_cast<std::int64_t>(iy)) * 0x85ebca77u + seed);
    const auto part = [&](int shift) { return static_cast<double>((hash >> shift) & 255u) / 255.0; };
    const double dx = cx - ix - 0.3 - 0.4 * part(0);
    const double dy = cy - iy - 0.3 - 0.4 * part(8);
    const double radius = 0.18 + 0.16 * part(16);
    const double distance = std::sqrt(dx * dx + dy * dy);
    sum += (part(24) - 0.42) * smooth_step((radius - distance) / edge + 0.5);
  }
  return weight * 0.4 * sum;
}

double Texture::patches(double x, double y, double footprint) const {
  const double noise = gradient_noise(x / 0.9, y / 1.6, seed_ + 77u) / gradient_noise_sigma;
  const double edge = std::max(0.25, footprint * 4);
  return -0.16 * smooth_step((noise - 1.4) / edge + 0.5);
}

double Texture::pavement(double x, double y, const Footprint& footprint) const {
  constexpr double kerbstone_width = 0.27;  // with its face
  constexpr double kerbstone_length = 1;
  constexpr double slab = 0.5;
  constexpr double half_joint = 0.006;
  const double beyond = x - kerb_x_ - kerbstone_width;
  const double length = beyond < 0 ? kerbstone_length : slab;
  const double along = bar(distance_to_multiple(y, length), half_joint, footprint.y);
  const double across = beyond < -half_joint ? 0 : bar(distance_to_multiple(beyond, slab), half_joint, footprint.x);
  const double contrast = resolved(length, 3 * std::max(footprint.x, footprint.y));
  const double tone = pavement_tone + (kerbstone_tone - pavement_tone) *
                                          bar(beyond + kerbstone_width / 2, kerbstone_width / 2, footprint.x);
  return tone * (1 - 0.35 * contrast * std::max(across, along));
}

double Texture::verge(double x, double y, const Footprint& footprint) const {
  // The edge of the asphalt is irregular.
  const double raggedness = 0.12 * gradient_noise(y / 0.7, 0.5, seed_ + 78u) / gradient_noise_sigma;
  const double width = std::max(0.04, 1.5 * footprint.x);
  return smooth_step((std::max(verge_left_m_ - x, x - verge_right_m_) + raggedness) / width + 0.5);
}

double Texture::paint(double x, double y, const Footprint& footprint) const {
  constexpr double dashes_x = -1.5;
  constexpr double edge_line_x = -5;
  constexpr double half_width = 0.06;
  constexpr double period = 4;
  constexpr double half_dash = 1;
  const double edge_line = bar(x - edge_line_x, half_width, footprint.x);
  const double dashes = bar(x - dashes_x, half_width, footprint.x);
  if (dashes == 0) return edge_line;
  return dashes * bar(distance_to_multiple(y - 2.5, period), half_dash, footprint.y);
}

double Texture::grey(const SurfacePoint& point, const Footprint& footprint) const {
  // The texture follows the faces of kerbs and the depth of damage, so that it is not smeared on walls.
  const double x = point.x + field_.kerb_rise(point.x);
  const double fine = std::min(footprint.x, footprint.y);
  const double coarse = std::max(footprint.x, footprint.y);
  double grain = aggregate(x, point.y, point.offset, footprint);
  grain += stones(x, point.y, 0.012, coarse, seed_ + 11u) + stones(x, point.y, 0.005, coarse, seed_ + 12u);
  double base = 1;
  if (x > kerb_x_) {
    base = pavement(x, point.y, footprint);
  } else {
    const double verge_share = verge(x, point.y, footprint);
    base += verge_share * (verge_tone - 1);
    grain = grain * (1 + 0.5 * verge_share) + patches(x, point.y, fine) * (1 - verge_share);
  }
  double grey = road_grey * base * std::max(0.15, 1 + contrast_ * grain);
  if (lane_marking_) {
    // There is no paint inside damage.
    const double share = paint(x, point.y, footprint) * smooth_step((point.light - 0.6) / 0.4) *
                         std::clamp(0.85 + 1.5 * contrast_ * grain, 0.2, 1.0);
    grey += share * (paint_grey_ * (1 + 0.4 * contrast_ * grain) - grey);
  }
  return grey * point.light * lambert(point.slope_x, point.slope_y);
}

double Texture::box_grey(const Box& box, const Vec3& point, double pixel_m) const {
  const AxisAlignedBox bounds = bounds_of(box);
  // The face that the point is nearest to, with two coordinates along it.
  const double to_top = std::abs(point.z - bounds.upper.z);
  const double to_side = std::min(std::abs(point.x - bounds.lower.x), std::abs(point.x - bounds.upper.x));
  const double to_front = std::min(std::abs(point.y - bounds.lower.y), std::abs(point.y - bounds.upper.y));
  const double nearest = std::min({to_top, to_side, to_front});
  double across = point.x, along = point.y, light = 1;
  if (nearest == to_side) {
    across = point.z;
    light = point.x < box.x_m ? 0.9 : 0.55;
  } else if (nearest == to_front) {
    along = point.z;
    light = 0.7;
  }
  const double grain = octaves(across, along, 0, pixel_m, seed_ ^ box.seed);
  double base = 1;
  if (box.panel_m > 0) {
    const double share = bar(distance_to_multiple(across, box.panel_m), 0.3 * box.panel_m, pixel_m) *
                         bar(distance_to_multiple(along, box.panel_m), 0.3 * box.panel_m, pixel_m);
    base -= 0.65 * share * resolved(box.panel_m, pixel_m);
  }
  return box.grey * base * light * std::max(0.15, 1 + box.texture_contrast * grain);
}

double Texture::shade(double x, double y) const {
  if (shade_ == 0) return 1;
  const double crowns =
      gradient_noise(x / 3.1, y / 3.1, seed_ + 79u) + 0.6 * gradient_noise(x / 0.5, y / 0.5, seed_ + 80u);
  return 1 - shade_ * smooth_step(crowns / (0.5 * gradient_noise_sigma) + 0.5);
}

double Texture::wet_grey(double grey, const Vec3& point, const Vec3& direction) const {
  if (wet_share_ == 0) return grey;
  const double film = gradient_noise(point.x / 1.3, point.y / 2.1, seed_ + 81u) / gradient_noise_sigma;
  // Logistic approximation of the quantile of the normal distribution.
  const double level = wet_share_ < 1 ? std::log(wet_share_ / (1 - wet_share_)) / 1.702 : 10;
  const double wet = smooth_step(2 * (level - film) + 0.5);
  const double length = std::sqrt(direction.x * direction.x + direction.y * direction.y + direction.z * direction.z);
  // Schlick's approximation of the reflectance of water, and a mirrored world of clouds and houses.
  const double mirrored = 0.02 + 0.98 * std::pow(1 + direction.z / length, 5);
  const double world =
      170 * (1 + 0.35 * gradient_noise(14 * direction.x / length, 14 * direction.z / length, seed_ + 82u) /
                     gradient_noise_sigma);
  return grey * (1 - 0.4 * wet) + wet * std::min(1.0, 4 * mirrored) * std::max(0.0, world);
}

double sky_grey(const Vec3& direction) {
  const double flat = std::hypot(direction.x, direction.y);
  return 190 + 40 * std::clamp(direction.z / std::max(flat, 1e-9), 0.0, 1.0);
}

}  // namespace roadstereo::synth
