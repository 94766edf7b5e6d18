#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "roadstereo/calibration.hpp"
#include "roadstereo/ground_plane.hpp"
#include "roadstereo/image.hpp"
#include "roadstereo/perspective_shift.hpp"
#include "roadstereo/road_model.hpp"
#include "roadstereo/severity.hpp"

#pragma GCC visibility push(default)
namespace roadstereo {

/// Whether a damage lies below or above the road's surface. `Distress` is the finer classification.
enum class DamageKind {
  depression,  ///< below: pothole, settlement, rut, wide crack
  protrusion   ///< above: bump, heave, debris
};
const char* name_of(DamageKind kind);

struct DamageOptions {
  double threshold_sigma = 5;  ///< minimum depth in standard deviations of the intact road, 1 … 100
  double min_depth_m = 0.005;  ///< minimum depth along the road's normal, metres, 0 … 10; used when calibrated
  double max_depth_m = 1;      ///< maximum depth, metres, min_depth_m … 10; deeper regions are ditches
  double max_height_m = 0.12;  ///< maximum height, metres, min_depth_m … 10; higher regions are kerbs or vehicles
  double min_area_m2 = 0.001;  ///< minimum area on the road's surface, m², 0 … 1e4, and 64 pixels; used when calibrated
  double min_area_share = 0.001;  ///< minimum area as a share of the image, 0 … 1; used without a calibration
  double min_confidence = 0.5;    ///< of a damage, 0 … 1; regions below are candidates. 0: all regions are damages
  bool protrusions = true;        ///< whether to find bumps, heave and debris too
  double mount_yaw_deg = 0;       ///< yaw of the camera relative to the direction of travel, clockwise, −360 … 360:
                                  ///< ruts and kerbs run along the road
  SeverityScheme severity = astm_d6433();  ///< tables of severities

  /// Throws Error naming the first option out of range.
  void validate() const;
};

/// Maps and geometry of one frame. All views are W×H; an empty view is absent.
struct DamageInput {
  ImageView<const float> transformed;  ///< ℓ', pixels; NaN invalid. Depressions lie below the road, protrusions above
  ImageView<const float> disparity;    ///< ℓ, pixels; required for metric results, with `plane` for slopes of walls
  ImageView<const float> matched;  ///< what `disparity` was before a rig bias was subtracted from it: where in `right`
                                   ///< a pixel is found; empty: `disparity` itself
  ImageView<const float> sigma;  ///< standard error of ℓ, pixels; when absent, noise is estimated from `transformed`
  int smoothing_px = 0;          ///< RefinementOptions::smoothing_px of the maps, 0 … 32; tells how far walls spread
  ImageView<const std::int16_t> grey;  ///< left image, 1/16 grey level (`to_grey`); refines outlines at holes
  /// Right image. With `plane`, it limits the search to what both cameras see. With `grey` and `disparity`, it helps to
  /// tell damage from what only one camera sees, such as rain.
  ImageView<const std::int16_t> right;
  ImageView<const std::uint8_t> mask{};   ///< not 0: outside the view, like pixels beyond the border of the image;
                                          ///< empty: no mask
  std::optional<PerspectiveShift> shift;  ///< shift with which `disparity` was matched; gives the searched range and
                                          ///< the misalignment
  std::optional<DisparityPlane> plane;  ///< the road's plane in ℓ, in whose coordinates the surface is fitted; required
                                        ///< for metric results
  std::optional<StereoCalibration> calibration;  ///< required for metric results

  /// Disparity between the two images.
  ImageView<const float> disparity_in_images() const { return matched.empty() ? disparity : matched; }
};

/// Metric properties of a damage. Depth is measured along the road's normal from the undamaged surface, interpolated
/// across the damage. It is positive for depressions and for protrusions.
struct DamageMetrics {
  Measurement area_m2;       ///< on the road's surface
  Measurement max_depth_m;   ///< maximum depth, or height of a protrusion
  Measurement mean_depth_m;  ///< volume over area, interpolated holes included
  Measurement volume_m3;
  double length_m = 0;    ///< longer side of the minimum-area rectangle on the road
  double width_m = 0;     ///< shorter side of that rectangle
  double angle_rad = 0;   ///< from the road's x axis to the longer side, positive towards y, −π/2 … π/2
  double diameter_m = 0;  ///< diameter of the circle of equal area
  /// Mean slope of the wall between a quarter and three quarters of the maximum depth. A lower bound, since the support
  /// window flattens walls.
  double wall_slope = 0;
  std::vector<std::array<double, 2>> outline_m;  ///< (x, y), `road_axes`; counterclockwise, not closed
  std::array<double, 3> centroid_m{};            ///< on the undamaged surface, camera frame
  std::array<double, 2> road_centroid_m{};       ///< (x, y) of the centroid in the axes of `road_axes`
  double distance_m = 0;                         ///< from the left camera to the centroid
  double resolvable_depth_m = 0;                 ///< smallest resolvable depth here: threshold_sigma standard errors
  Distress distress = Distress::unknown;
  double quantity = 0;  ///< in `unit`, counted as the table of the distress prescribes
  DistressUnit unit = DistressUnit::count;
  SeverityProbabilities severity_probabilities;  ///< all 0 if the scheme has no classes for the distress
  Severity severity = Severity::unknown;
};

/// Return the figures that decided the distress, in words: slope of the wall, elongation.
std::string distress_reason(const DamageMetrics& metrics);

/// Return the severity in words: a class, a range such as "medium–high" where no class has more than half of the
/// probability, "unresolvable", or "not graded" if there is no table or the area is uncertain by more than
/// ±50 %.
std::string severity_text(const DamageMetrics& metrics);

/// Evidence that distinguishes a damage from noise and from objects beside the road. No single value decides.
struct DamageEvidence {
  /// Depth of the floor minus the median of the surrounding band, or of that half of it where the contrast is least, in
  /// robust standard deviations there, or of the road around (three bands, or all intact road) if these are larger
  double contrast_sigmas = 0;
  double significance = 0;  ///< contrast · √(support windows inside, a cell counting (depth / depth of the floor)²)
  double steepness = 0;     ///< maximum of the mean slope on a contour, relative to a cone of the same area and depth
  double road_share = 0;    ///< share of the band around that is road, 0 … 1
  double border_share = 0;  ///< share of the outline on the border of what both cameras see, 0 … 1
  double unseen_share = 0;  ///< share of the outline on a gap in the disparities that reaches that border, 0 … 1
  /// By how much better the images correlate along the measured surface than along the undamaged road, over the blocks
  /// inside, in standard errors; NaN unknown. Something that only one camera sees correlates along neither, while the
  /// texture around it correlates along the road.
  double surface_significance = std::numeric_limits<double>::quiet_NaN();
  /// Mean vote of the windows inside, −1 … 1: whether the images correlate better at the measured disparities (1) or at
  /// any disparity outside the searched range (−1); NaN unknown. 0 or less where the image shows something other than
  /// road, such as the roof of a vehicle.
  double range_vote = std::numeric_limits<double>::quiet_NaN();
  /// RMS, over the inside, of the excess brightness of one image over the other, as far as it is brighter than the
  /// surrounding road, relative to the brightness of that road; NaN unknown. Matte surfaces have 0.02 and less, glint
  /// on a wet road up to 0.5.
  double specular_excess = std::numeric_limits<double>::quiet_NaN();
  /// Share of the image around a protrusion that has the texture of its inside rather than that of the road, less the
  /// share of the road that has it, −1 … 1; NaN if unknown and for depressions. About 0 if road surrounds it, 0.3 and
  /// more on a verge.
  double texture_share = std::numeric_limits<double>::quiet_NaN();
  /// Upper quartile of the depths, or heights, of the pixels inside, each divided by its own standard error without the
  /// error of smoothing; NaN without `DamageInput::sigma`. Where matching failed, the errors are as large as the
  /// depths.
  double pixel_significance = std::numeric_limits<double>::quiet_NaN();
  /// Slope of the wall of a depression, rise over run, at most 1: geometric mean of `DamageMetrics::wall_slope` and of
  /// the steepest slope that the support window would flatten to it; NaN if unknown and for protrusions. It
  /// distinguishes a pothole that the border cuts from the relief of the road.
  double likely_wall_slope = std::numeric_limits<double>::quiet_NaN();
  /// Diameter of the circle of equal area divided by 1.5 m, half of the straightedge (3 m) to which the resolution of
  /// the fitted road surface is matched; a region above 1 may be the shape of the road or lie beside it. NaN without a
  /// calibration.
  double extent = std::numeric_limits<double>::quiet_NaN();

  /// For a region in a rut: depth of the rut below a straightedge across the road, in standard errors, times the share
  /// of the region that lies in the rut; else 0. A rut continues along the road and is as gentle as its relief.
  double rut_significance = 0;

  /// Expected number of other regions of the image that are noise: twice the smaller of the sums of 1 − confidence over
  /// its other hollows and over its other protrusions, since noise makes as many of both. 0 without a search for
  /// protrusions.
  double clutter = 0;

  /// Maximum depth in standard errors, without the error of smoothing, which only makes a damage shallower. Below 3 the
  /// damage is unresolvable, unless its mean depth is at least three of its standard errors.
  double depth_significance = 0;
  bool is_depth_resolved() const { return depth_significance >= min_resolved_sigmas; }

  /// Probability that the region is damage, 0 … 1: logistic regression on the evidence (docs/damage.md).
  double confidence() const;
};

/// One damage: a connected component of the left image.
struct Damage {
  int id = 0;  ///< value in `DamageMap::ids`, 1 … 65535; the numbers of candidates follow those of the damages and are
               ///< not in `ids`
  DamageKind kind = DamageKind::depression;
  std::size_t pixels = 0;
  double measured_share = 0;            ///< share of the pixels with a disparity, 0 … 1
  std::array<double, 2> centroid_px{};  ///< (u, v)
  std::array<int, 4> box_px{};          ///< bounding box, both ends inclusive: u0, v0, u1, v1
  std::array<int, 2> deepest_px{};      ///< (u, v) of the maximum depth
  Measurement max_depth_px;             ///< maximum |depth| in ℓ', pixels
  double mean_depth_px = 0;             ///< mean |depth| over the pixels with a disparity
  double confidence = 0;                ///< that this is damage, 0 … 1: `DamageEvidence::confidence`
  DamageEvidence evidence;
  bool cut_by_border = false;  ///< touches the border of what both cameras see, or what is masked: it may be larger
  bool ends_search = false;    ///< its floor lies at the end of the searched disparities: it may be deeper, and the
                               ///< standard errors of depth and volume are at least as large as the values
  std::optional<DamageMetrics> metrics;  ///< absent without a calibration

  /// Maximum depth: metres if there are `metrics`, else pixels of ℓ'.
  const Measurement& max_depth() const { return metrics ? metrics->max_depth_m : max_depth_px; }
};

/// Damage of one frame. Images are W×H of the input.
struct DamageMap {
  std::vector<Damage> damages;     ///< deepest first
  std::vector<Damage> candidates;  ///< not damages: unresolvable, or below min_confidence; deepest first, not in `ids`
  Image<std::uint16_t> ids;        ///< id of the damage at each pixel; 0: none
  Image<std::uint8_t> road;        ///< 255 in the road region, damage included; 0 outside
  Image<float> surface;            ///< ℓ' of the undamaged road, pixels; extrapolated across damage and off the road
  Image<float> depth;  ///< depth below the undamaged road, negative above it: metres along the road's normal if
                       ///< `metric`, else pixels of ℓ'. Interpolated in the holes of damages; NaN in other holes
                       ///< and where the right camera does not see the road
  double noise_px = std::numeric_limits<double>::quiet_NaN();  ///< robust standard deviation of the intact road around
                                                               ///< `surface`, per cell, pixels; NaN without a road
  bool metric = false;                                         ///< whether `depth` is in metres
  std::string non_metric_reason;                               ///< why `metric` is false; empty if it is true

  /// Whether a road was found. Without one, an empty list says nothing about damage.
  bool has_road() const { return !std::isnan(noise_px); }
};

/// Find and measure the regions that differ from the road's surface: IRLS fit of a quadratic road surface, hysteresis
/// thresholding of the depth below it, measurement of each connected component. A frame without damage gives an empty
/// list. `threads` 0 uses all cores. Throws Error when the map is smaller than 32×32, has no valid pixel or only one
/// value, when fewer than 32 samples lie on the road, when the sizes of the views differ or the calibration is of
/// another one, and when `smoothing_px` or an option is out of range.
DamageMap find_damage(const DamageInput& input, const DamageOptions& options = {}, int threads = 0);

/// Find damage, reusing the memory of an earlier result of the same size: allocating the maps takes about as long as
/// filling them. `result` is unspecified after an error.
void find_damage(const DamageInput& input, const DamageOptions& options, int threads, DamageMap& result);

/// Make a result without road and without damage. `reason` becomes `non_metric_reason`.
DamageMap make_empty_damage_map(int width, int height, const std::string& reason);

}  // namespace roadstereo
#pragma GCC visibility pop
