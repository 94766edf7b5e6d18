#pragma once

#include <cstddef>
#include <cstdint>

#include "road/off_road/confirmation.hpp"

// Sums over the columns of pixels of a row of cells, with vector instructions.

namespace roadstereo {

/// One value a column, structure of arrays.
struct ColumnSums {
  std::int32_t* log_sigmas;  ///< of log2 σ / pixel, 1/256
  std::int32_t* sigmas;      ///< number of them
  float* residuals;
  std::int32_t* known;  ///< number of them
};

/// A row of the maps.
struct MapRow {
  const float* sigma;
  const std::uint8_t* mask;  ///< may be null; standard errors of masked pixels do not count
  const float* disparity;
  RowLine shift;
  int width;
};

void add_row(const MapRow& row, const ColumnSums& sums);

}  // namespace roadstereo
