#pragma once

#include "core/cuda/memory.hpp"
#include "core/cuda/stream.hpp"
#include "road/cuda/fitted_plane.hpp"

namespace roadstereo::cuda {

/// Points of disparity space in device memory; those whose `d` is NaN are missing, and have a finite place all the
/// same.
struct DevicePoints {
  const float* u;
  const float* v;
  const float* d;
  int count;  ///< with the missing ones, at most max_fit_points
};

/// As many as a block holds in its registers.
inline constexpr int max_fit_points = 7168;

/// Throws Error when there are more.
void require_fit_points(int count);

struct RobustFit {
  double start_scale_px;  ///< window that the fit begins with
  bool with_roll;
  int max_iterations;
};

/// fit_plane_irls() on the device: iteratively reweighted least squares in one block.
class RobustPlaneFit {
 public:
  /// Enqueues the fit of `points`. Throws Error when there are too many.
  void run(const DevicePoints& points, const PlaneSource& start, const RobustFit& fit, StreamView stream);

  const FittedPlane* plane() const { return fitted_.data(); }  ///< in device memory
  const float* weights() const { return weights_.data(); }  ///< in device memory: Tukey weights, 0 for missing points
  const FittedPlane& result() const { return *result_.data(); }  ///< once the stream was synchronised

 private:
  DeviceArray<FittedPlane> fitted_{1};
  DeviceArray<float> weights_;
  PinnedArray<FittedPlane> result_{1};
};

}  // namespace roadstereo::cuda
