#include "pipeline/support_samples.hpp"

#include "stereo/adaptive_support.hpp"
#include "stereo/window.hpp"

namespace roadstereo {

SupportSamples::SupportSamples(const MatcherOptions& options)
    : options_(without_prior(options)), samples_(effective_samples(options)) {}

double SupportSamples::of(const MatcherOptions& options) {
  const MatcherOptions support = without_prior(options);
  if (!(support == options_)) {
    samples_ = effective_samples(options);
    options_ = support;
  }
  return samples_;
}

}  // namespace roadstereo
