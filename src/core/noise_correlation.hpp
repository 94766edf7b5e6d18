#pragma once

namespace roadstereo {

/// Correlation of a pair whose noise is white after downsampling by `factor`, which averages that noise over factor²
/// pixels; 0 stays unknown.
inline double downsampled_correlation(double correlation, double factor) {
  const double signal = factor * factor * correlation;
  return signal / (signal + 1 - correlation);
}

/// The inverse: correlation of the full-size pair from that of the pair downsampled by `factor`.
inline double full_size_correlation(double downsampled, double factor) {
  return downsampled_correlation(downsampled, 1 / factor);
}

}  // namespace roadstereo
