#pragma once

#include "core/cuda/launch.hpp"
#include "road/refinement/measured.hpp"
#include "road/row_shift.hpp"
#include "roadstereo/image_view.hpp"

// The maps that the refinement reads, for its kernels.

namespace roadstereo::cuda {

/// Disparities and their variances.
struct MeasuredMaps {
  ImageView<const float> disparity, variance;
  DisparityPlane road;

  /// The road in row v. Double precision is slow on small GPUs: once a row suffices.
  __device__ RowLine road_line(int v) const { return row_line(road, v, 0); }
};

/// What the maps hold of a pixel.
struct MapPixel {
  float disparity, variance;
};

/// Reads a pixel of the map, outside the nearest one: loads without a condition are issued together.
__device__ inline MapPixel read_pixel(const MeasuredMaps& maps, int u, int v) {
  const int column = min(max(u, 0), maps.disparity.width() - 1), row = min(max(v, 0), maps.disparity.height() - 1);
  return {__ldg(&maps.disparity(column, row)), __ldg(&maps.variance(column, row))};
}

__device__ inline MeasuredHeight measured_at(const MeasuredMaps& maps, const MapPixel& pixel, const RowLine& road,
                                             const VarianceBounds& bounds, int u, int v) {
  if (u < 0 || u >= maps.disparity.width() || v < 0 || v >= maps.disparity.height()) return not_measured();
  return measured(pixel.disparity, pixel.variance, road.at(static_cast<float>(u)), bounds);
}

}  // namespace roadstereo::cuda
