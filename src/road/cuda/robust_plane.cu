#include "core/cuda/launch.hpp"
#include "road/cuda/robust_fit.hpp"
#include "road/cuda/robust_plane.hpp"

// Floor: see robust_fit.hpp.
namespace roadstereo::cuda {
namespace {

__global__ void __launch_bounds__(1024) fit_plane(DevicePoints points, PlaneSource start, RobustFit fit, float* first,
                                                  float* weights, FittedPlane* fitted, FittedPlane* result) {
  FitState& state = *shared_memory<FitState>();
  auto* residuals = reinterpret_cast<float*>(&state + 1);
  BlockFit block(points, fit, state, residuals, first, weights);
  const FittedPlane found = block.run(start.get());
  if (threadIdx.x != 0) return;
  *fitted = found;
  *result = found;  // not read back: it lies in the host's memory
}

}  // namespace

void RobustPlaneFit::run(const DevicePoints& points, const PlaneSource& start, const RobustFit& fit,
                         StreamView stream) {
  require_fit_points(points.count);
  first_.reserve(static_cast<std::size_t>(points.count));
  weights_.reserve(static_cast<std::size_t>(points.count));
  launch("fit_plane", fit_plane, {1, fit_threads(points.count), fit_shared_bytes(points.count)}, stream, points, start,
         fit, first_.data(), weights_.data(), fitted_.data(), result_.data());
}

}  // namespace roadstereo::cuda
