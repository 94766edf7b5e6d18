#include "road/cuda/robust_plane.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::cuda {

void require_fit_points(int count) {
  if (count > max_fit_points) {
    fail("a plane is to be fitted to ", count, " places at once; the device takes at most ", max_fit_points);
  }
}

}  // namespace roadstereo::cuda
