#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "roadstereo/calibration.hpp"

#pragma GCC visibility push(default)
namespace roadstereo {

struct DamageMap;
struct FrameResult;

/// Disparity error of a rig over the left image, caused by residual distortion and rectification errors: a polynomial
/// in
/// x = (u − (W − 1)/2) / (W/2) and y = (v − (H − 1)/2) / (W/2). Its terms, degree by degree: 1, x, y, x², xy, y², x³,
/// x²y, xy², y³, x⁴, x³y, x²y², xy³, y⁴. The first three cannot be distinguished from the plane of the road; they are
/// chosen so that subtracting the field does not move that plane.
struct RigBias {
  static constexpr int max_order = 4;
  static constexpr std::size_t terms = 15;
  static constexpr std::size_t plane_terms = 3;

  int width = 0;                             ///< of the frames, pixels
  int height = 0;                            ///< pixels
  double focal_px = 0;                       ///< of their calibration, pixels; 0: none
  int order = 0;                             ///< highest degree, 2 … 4; 0: no field
  std::array<double, terms> value_px{};      ///< coefficients
  std::array<double, terms> std_error_px{};  ///< of each; 0 of the first three
  std::array<double, 4> region_px{};         ///< u0, v0, u1, v1; outside this region the field has its value at the
                                             ///< nearest border
  double rms_px = 0;                         ///< root mean square of the field over the road
  double rms_std_error_px = 0;
  int frames = 0;  ///< that it was estimated from

  /// Returns the field at a pixel of the left image: the amount by which its disparity is too large, pixels.
  double at(double u, double v) const;

  /// Throws Error naming the first value that is out of range.
  void validate() const;
  /// Throws Error unless the field belongs to frames of this size and, where both are known, to this focal length.
  void require_rig(int frame_width, int frame_height, const std::optional<StereoCalibration>& calibration) const;
};

struct RigBiasOptions {
  int max_order = RigBias::max_order;  ///< highest degree that is tried, 2 … 4
  double min_std_errors = 5;  ///< significance below which a degree is left out: its largest coefficient in standard
                              ///< errors, 1 … 100
  int min_frames = 16;        ///< with fewer there is no field, 16 … 1000000

  /// Throws Error naming the first option that is out of range.
  void validate() const;
};

/// Contribution of one frame to the field: its normal equations, from which the road plane of the frame is eliminated.
struct RigBiasFrame {
  static constexpr std::size_t free_terms = RigBias::terms - RigBias::plane_terms;

  int width = 0;
  int height = 0;
  std::array<double, 4> region_px{};                               ///< u0, v0, u1, v1 of the road
  double weight = 0;                                               ///< of all its samples, 1/px²
  std::array<double, free_terms*(free_terms + 1) / 2> matrix{};    ///< lower half, row after row
  std::array<double, free_terms> vector{};                         ///< right-hand side
  std::array<double, RigBias::plane_terms * free_terms> planes{};  ///< plane of each term over the road, times `weight`
};

/// Measures the residuals of the road's disparities from its plane: means of cells outside damage, weighted by their
/// standard errors (IRLS with Tukey's biweight). Empty without a road, with too little of it, or without standard
/// errors of the disparities. Throws Error when the maps differ in size.
std::optional<RigBiasFrame> measure_rig_bias(const FrameResult& frame, const DamageMap& damage);

/// Estimates the field that the frames of a recording have in common. Every frame has a plane of its own. Standard
/// errors by blocking (Flyvbjerg and Petersen): the scatter of batches of successive frames, for the length of batch
/// that gives the largest, so that neighbouring pixels and frames do not count twice. A shape that the road itself has
/// in all frames, such as the crown of one lane, becomes part of the field; its standard errors do not show this.
class RigBiasEstimator {
 public:
  /// Throws Error when an option is out of range.
  explicit RigBiasEstimator(const RigBiasOptions& options = {});

  /// Adds the next frame, unless its size differs from that of the first. Memory does not grow after 64 frames.
  void add(const RigBiasFrame& frame);

  /// Number of frames so far.
  int frames() const { return frames_; }

  /// Returns the field of the frames so far. Its order is 0 with too few frames or if no degree is significant.
  RigBias estimate(const std::optional<StereoCalibration>& calibration) const;

 private:
  RigBiasOptions options_;
  int frames_ = 0;
  int batch_frames_ = 1;  ///< frames of a whole batch
  int last_frames_ = 0;   ///< of the last batch
  std::vector<RigBiasFrame> batches_;
};

}  // namespace roadstereo
#pragma GCC visibility pop
