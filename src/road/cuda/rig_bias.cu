// Floor: 8 bytes and some 30 operations a pixel, of which the row's own could be shared.

#include "core/cuda/launch.hpp"
#include "road/cuda/rig_bias.hpp"

namespace roadstereo::cuda {
namespace {

constexpr int row_threads = 128;

__global__ void subtract_rows(BiasPolynomial<float> bias, ImageView<float> disparity) {
  begin_kernel();
  const int u = static_cast<int>(blockIdx.x) * row_threads + static_cast<int>(threadIdx.x);
  const int v = static_cast<int>(blockIdx.y);
  if (u >= disparity.width()) return;
  disparity(u, v) -= bias.row(static_cast<float>(v)).at(static_cast<float>(u));
}

}  // namespace

void subtract_bias(const BiasPolynomial<float>& bias, ImageView<float> disparity, StreamView stream) {
  launch("subtract_rows", subtract_rows,
         {{blocks_for(disparity.width(), row_threads), static_cast<unsigned>(disparity.height())}, row_threads, 0},
         stream, bias, disparity);
}

}  // namespace roadstereo::cuda
