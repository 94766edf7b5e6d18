#pragma once

#include <string>
#include <vector>

#include "evaluate/sigma_calibration.hpp"

namespace roadstereo::cli {

/// The share within 2σ that is aimed at: 0.954 of normal errors, with room for what matching cannot know of itself.
inline constexpr double min_within_2 = 0.90;
inline constexpr double max_within_2 = 0.97;

/// What the figure shows of one group of pairs.
struct SigmaGroup {
  std::string name;
  SigmaCalibration visible;  ///< over what both cameras see
  SigmaCalibration damage;   ///< over the damage alone
};

/// Actual against predicted errors with the diagonal, the share within 2σ against σ with the band aimed at, and bars of
/// that share for every group.
Frame sigma_figure(const std::vector<SigmaBin>& visible, const std::vector<SigmaBin>& damage,
                   const std::vector<SigmaGroup>& groups);

}  // namespace roadstereo::cli
