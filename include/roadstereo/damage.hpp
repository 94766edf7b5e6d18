#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "roadstereo/calibration.hpp"
#include "roadstereo/image.hpp"
#include "roadstereo/road_model.hpp"
#include "roadstereo/road_plane.hpp"

namespace roadstereo {

enum class DamageKind {
  depression,  ///< pothole, settlement, wide crack
  protrusion   ///< bump, heave, debris
};
const char* name_of(DamageKind kind);

/// ASTM D6433's table for potholes: depth against mean diameter.
enum class Severity {
  unknown,       ///< no calibration
  unresolvable,  ///< below what the rig can tell apart at this distance
  minor,         ///< shallower than 13 mm or narrower than 100 mm: not in the table
  low,
  medium,
  high
};
const char* name_of(Severity severity);

/// Severity of a pothole by ASTM D6433: depth 13–25, 25–50, > 50 mm against mean diameter 100–200, 200–450, 450–750 mm.
Severity astm_severity(double depth_m, double diameter_m);

struct DamageOptions {
  double threshold_sigma = 5;     ///< depth that counts as damage, in standard errors of the road's surface
  double min_depth_m = 0.005;     ///< ... and in metres along the road's normal, when calibrated
  double max_depth_m = 0.3;       ///< what lies deeper is no damage but a ditch
  double max_height_m = 0.12;     ///< what rises higher is no damage but a kerb, an island or a vehicle
  double min_area_m2 = 0.001;     ///< on the road's surface, when calibrated
  double min_area_share = 0.001;  ///< share of the image; instead of min_area_m2 without a calibration
  bool protrusions = true;        ///< find bumps, heave and debris as well

  void validate() const;
};

/// What is known of a frame. Views have one size; an empty view is absent.
struct DamageInput {
  ImageView<const float> transformed;  ///< ℓ', pixels; NaN invalid; depressions below the road, protrusions above it
  ImageView<const float> disparity;    ///< ℓ, pixels; needed for everything metric
  ImageView<const float> sigma;        ///< standard error of ℓ, pixels; without it noise is measured in the map
  ImageView<const std::int16_t>
      grey;  ///< left image as `to_grey` gives it: helps to draw outlines where matching left holes
  std::optional<RoadModel> plane;                ///< the road's plane in ℓ; needed for everything metric
  std::optional<StereoCalibration> calibration;  ///< needed for everything metric
};

/// A figure with its standard error.
struct Measured {
  double value = 0;
  double std_error = 0;
};

/// A damage in metres. Depth counts along the road's normal from the undamaged surface interpolated across the hole;
/// it is positive for depressions and for protrusions alike.
struct DamageMetrics {
  Measured area_m2;       ///< on the road's surface
  Measured max_depth_m;   ///< largest depth (height, of a protrusion)
  Measured mean_depth_m;  ///< over the whole region, holes included
  Measured volume_m3;
  double length_m = 0;                 ///< longer side of the smallest oriented box on the road
  double width_m = 0;                  ///< its shorter side
  double angle_rad = 0;                ///< of the longer side against the road's x axis, −π/2 … π/2, towards y
  double diameter_m = 0;               ///< mean diameter: of the circle of this area
  std::array<double, 3> centroid_m{};  ///< camera frame, on the undamaged surface
  std::array<double, 2> road_centroid_m{};  ///< (x, y) in the frame of `road_frame`
  double distance_m = 0;                    ///< from the left camera to the centroid
  double resolvable_depth_m = 0;  ///< smallest depth that this rig tells apart there: threshold_sigma standard errors
  Severity severity = Severity::unknown;
};

/// One damage: a connected region of the left image.
struct Damage {
  int id = 0;  ///< its value in `DamageMap::ids`, 1 … 65535
  DamageKind kind = DamageKind::depression;
  std::size_t pixels = 0;
  double measured_share = 0;             ///< share of the pixels that have a disparity
  std::array<double, 2> centroid_px{};   ///< (u, v)
  std::array<int, 4> box_px{};           ///< first and last column and row: u0, v0, u1, v1
  std::array<int, 2> deepest_px{};       ///< (u, v) of the largest depth
  Measured max_depth_px;                 ///< largest departure from the road in ℓ'
  double mean_depth_px = 0;              ///< over the pixels that have a disparity
  bool cut_by_border = false;            ///< reaches the border of the image: it may be larger than seen
  std::optional<DamageMetrics> metrics;  ///< absent without a calibration
};

/// Damage of one frame.
struct DamageMap {
  std::vector<Damage> damages;  ///< deepest first
  Image<std::uint16_t> ids;     ///< of the damage at each pixel, 0 none
  Image<std::uint8_t> road;     ///< 255 on the road region (damage included), 0 off it
  Image<float> surface;         ///< ℓ' of the undamaged road, pixels, continued across damage and off the road
  Image<float> depth;  ///< below the undamaged road, negative above: metres along the normal when calibrated, else
                       ///< pixels of ℓ'; interpolated in the holes of damages; NaN elsewhere without a disparity
  double noise_px =
      0;  ///< standard deviation of the intact road, in means of a few pixels, around `surface`; pixels, robust
  bool metric = false;          ///< whether `depth` is in metres
  std::string unmetric_reason;  ///< why not
};

/// Finds and measures what differs from the road. No damage is a result, not an error.
/// Throws Error when the map has no disparities, one value only, or the views do not agree in size.
DamageMap find_damage(const DamageInput& input, const DamageOptions& options = {}, int threads = 0);

/// The same into an earlier result, whose maps keep their memory when the sizes are equal: fresh memory costs about as
/// much as painting it. `result` is unspecified after an error.
void find_damage(const DamageInput& input, const DamageOptions& options, int threads, DamageMap& result);

/// The result where nothing was found and no road either; `reason` says why nothing is metric.
DamageMap no_damage(int width, int height, const std::string& reason);

}  // namespace roadstereo
