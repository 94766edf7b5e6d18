#pragma once

#include "roadstereo/host_device.hpp"

namespace roadstereo {

/// First column of the downsampled image whose pixels all lie at or behind a column of the image.
ROADSTEREO_HD inline int coarse_column(int column, int factor, int coarse_width) {
  const int first = (column + factor - 1) / factor;
  return first < coarse_width ? first : coarse_width;
}

}  // namespace roadstereo
