#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "roadstereo/calibration.hpp"
#include "roadstereo/disparity_plane.hpp"
#include "roadstereo/image.hpp"

#pragma GCC visibility push(default)
namespace roadstereo {

/// Value of RoadModelOptions::pitch_deg that expects none.
inline constexpr double unknown_pitch_deg = -90;

struct RoadModelOptions {
  bool with_roll = true;              ///< estimate a2; false is the paper's model, eq. (4)
  double max_disparity_share = 0.35;  ///< largest disparity searched, as a share of the image width, 0.05 … 0.9
  double max_road_tilt_deg = 30.0;    ///< steepest sideways tilt of a road; a steeper plane is a wall, 5 … 80
  double min_evidence = 0.06;   ///< below this evidence (RoadModelEstimate) there is no road, 0 … 1; more of what may
                                ///< be a bonnet: nearer than a few baselines, or in few rows
  double weak_evidence = 0.15;  ///< below this evidence the road is weak, 0 … 1
  double verify_tolerance_px = 1.0;  ///< largest spread that a tracked road may leave, pixels of the image shrunk
                                     ///< by a power of two to less than 1920 columns, above 0 … 100
  double height_m = 0;               ///< expected height of the camera above the road, metres, 0 … 1000; 0: unknown
  double pitch_deg = unknown_pitch_deg;  ///< expected pitch of the camera below the horizon, −90 … 90; −90: unknown

  /// Throws Error naming the first option that is out of range.
  void validate() const;
};

/// Status of the road in a pair.
enum class RoadStatus {
  none,    ///< the pair shows no road, or gives no evidence of it: no roll, no metric values, no damage
  weak,    ///< a road with little evidence: it fills little of the picture, the picture is poor, or a wall or a plane
           ///< above the camera has far more
  found,   ///< found in this pair alone
  tracked  ///< the last frame's road, found again in this pair
};
const char* name_of(RoadStatus status);

/// Road model before matching.
struct RoadModelEstimate {
  DisparityPlane model;
  RoadStatus status = RoadStatus::none;
  std::string reason;              ///< why there is no road, or what speaks against it; else empty
  double evidence = 0;             ///< evidence for the plane per pixel of the part of the image where it would be
                                   ///< visible, taken as at least half of the image; about 0 … 2; 0 when tracked
  double inlier_share = 0;         ///< share of the textured samples below the horizon that the plane explains, 0 … 1
  bool samples_are_cells = false;  ///< whether these samples are cells of blocks, as in noise, and not single blocks
  double correlation = 0;       ///< 10th percentile of the NCC of blocks on the road at full size, 0 … 1; 0: unknown
  int matches = 0;              ///< reliable correspondences found over the whole image
  int inliers = 0;              ///< correspondences on the road
  double residual_px = 0;       ///< robust standard deviation of the inliers around the model, pixels
  double residual_p01_px = 0;   ///< 1st percentile of the residuals of the correspondences near the road, pixels
  double residual_p99_px = 0;   ///< 99th percentile of the same, pixels
  double max_disparity_px = 0;  ///< 99th percentile of all correspondences, for a search without a model

  bool has_road() const { return status != RoadStatus::none; }
};

/// Finds the road from the images alone: the plane with the most evidence over all pixels of the downsampled pair, then
/// a robust fit to correspondences along it. Never guesses: when the evidence is poor, the status is `none`.
/// `calibration`, when given, tells walls from roads by their real tilt, and is needed for an expected height or pitch.
/// Pixels where `mask` (W×H, or empty) is not 0 and a black or repeated border take no part. Near the `last` frame's
/// road, if it is given, a plane needs less evidence than elsewhere. Throws Error when the images look swapped (the
/// matches lie at negative disparities), when the sizes differ and when an option is out of range.
RoadModelEstimate estimate_road_model(ImageView<const std::int16_t> left, ImageView<const std::int16_t> right,
                                      const std::optional<StereoCalibration>& calibration,
                                      const RoadModelOptions& options, int threads = 0,
                                      ImageView<const std::uint8_t> mask = {},
                                      const std::optional<DisparityPlane>& last = std::nullopt);

/// The last frame's road, where tracking starts.
struct TrackedRoad {
  DisparityPlane model;
  double inlier_share = 0;         ///< RoadModelEstimate::inlier_share, 0 … 1
  double correlation = 0;          ///< RoadModelEstimate::correlation; unchanged if the last pair gave none
  bool samples_are_cells = false;  ///< RoadModelEstimate::samples_are_cells
};

/// Tracks the last frame's road: searches around `previous` and refits. The status is `none` when the road explains far
/// less of this pair than of the last one, or has moved farther than the search can see. `mask` and errors of size and
/// options as above.
RoadModelEstimate verify_road_model(ImageView<const std::int16_t> left, ImageView<const std::int16_t> right,
                                    const TrackedRoad& previous, const std::optional<StereoCalibration>& calibration,
                                    const RoadModelOptions& options, int threads = 0,
                                    ImageView<const std::uint8_t> mask = {});

/// The same by the mean correlation over cells of 5×5 blocks, which still determines the disparity where a single block
/// is lost in noise.
RoadModelEstimate verify_road_model_in_noise(ImageView<const std::int16_t> left, ImageView<const std::int16_t> right,
                                             const TrackedRoad& previous,
                                             const std::optional<StereoCalibration>& calibration,
                                             const RoadModelOptions& options, int threads = 0,
                                             ImageView<const std::uint8_t> mask = {});

}  // namespace roadstereo
#pragma GCC visibility pop
