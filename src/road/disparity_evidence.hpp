#pragma once

#include <cstddef>

#include "core/scratch.hpp"

namespace roadstereo {

/// Columns and rows of the downsampled image that one cell of the evidence covers.
inline constexpr int evidence_columns = 16;
inline constexpr int evidence_rows = 2;

/// Evidence of one cell for each of its disparities, summed over its pixels. Both come from the posterior of a pixel's
/// disparity given its correlations; a pixel without texture adds nothing.
struct EvidenceCell {
  float* support;  ///< logarithm-like score of the disparity, saturated for a single pixel: −0.53 … 3.2 each
  float* beyond;   ///< 0 … 1 each, near 1 where the pixel is surely farther away than the disparity: square of the
                   ///< share that the probability of all nearer ones lacks of chance
};

/// Evidence for disparities over the downsampled left image, rows × columns cells of `disparities` values.
class DisparityEvidence {
 public:
  DisparityEvidence() = default;
  DisparityEvidence(int rows, int columns, int disparities)
      : rows_(rows),
        columns_(columns),
        disparities_(disparities),
        support_(scratch_vector<float>(size())),
        beyond_(scratch_vector<float>(size())) {}

  int rows() const { return rows_; }
  int columns() const { return columns_; }
  int disparities() const { return disparities_; }

  EvidenceCell cell(int row, int column) {
    return {support_.data() + at(row, column), beyond_.data() + at(row, column)};
  }
  const float* support(int row, int column) const { return support_.data() + at(row, column); }
  const float* beyond(int row, int column) const { return beyond_.data() + at(row, column); }

 private:
  std::size_t at(int row, int column) const {
    return (static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column)) *
           static_cast<std::size_t>(disparities_);
  }
  std::size_t size() const { return at(rows_, 0); }

  int rows_ = 0, columns_ = 0, disparities_ = 0;
  ScratchVector<float> support_ = scratch_vector<float>(), beyond_ = scratch_vector<float>();
};

}  // namespace roadstereo
