#pragma once

#include "roadstereo/matcher.hpp"

namespace roadstereo {

/// effective_samples, computed only where the options have changed; the prior has no effect on it.
class SupportSamples {
 public:
  explicit SupportSamples(const MatcherOptions& options);

  /// Pixels that one disparity is computed from.
  double of(const MatcherOptions& options);

 private:
  MatcherOptions options_;
  double samples_;
};

}  // namespace roadstereo
