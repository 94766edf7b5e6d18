#include "core/cuda/launch.hpp"
#include "road/cuda/robust_fit.hpp"
#include "road/cuda/robust_plane.hpp"

// Floor: see robust_fit.hpp.
namespace roadstereo::cuda {
namespace {

__global__ void __launch_bounds__(max_fit_threads) fit_plane(DevicePoints points, PlaneSource start, RobustFit fit,
                                                             float* weights, FittedPlane* fitted, FittedPlane* result) {
  begin_kernel();
  FitState& state = *shared_memory<FitState>();
  RegisterSelect select(state.select);
  const FittedPlane found = BlockFit(points, fit, state, select).run(start.get(), weights);
  if (threadIdx.x != 0) return;
  *fitted = found;
  *result = found;  // not read back: it lies in the host's memory
}

}  // namespace

void RobustPlaneFit::run(const DevicePoints& points, const PlaneSource& start, const RobustFit& fit,
                         StreamView stream) {
  require_fit_points(points.count);
  weights_.reserve(static_cast<std::size_t>(points.count));
  launch("fit_plane", fit_plane, {1, fit_threads(points.count), sizeof(FitState)}, stream, points, start, fit,
         weights_.data(), fitted_.data(), result_.data());
}

}  // namespace roadstereo::cuda
