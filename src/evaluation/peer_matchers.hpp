#pragma once

#include <memory>
#include <string>
#include <vector>

#include "roadstereo/image.hpp"

namespace roadstereo::io {

/// OpenCV's matchers that a user would pick instead: "SGBM", "3WAY", "HH4", "BM".
const std::vector<std::string>& peer_names();

/// Returns how many disparities a matcher of OpenCV searches when it is asked for so many: a multiple of 16.
int peer_disparities(int disparities);

/// One of OpenCV's matchers with its usual settings, for comparison on the same frames.
class PeerMatcher {
 public:
  /// `disparities` is rounded up to a multiple of 16, which OpenCV asks for. Throws Error for an unknown name.
  PeerMatcher(const std::string& name, int disparities);
  ~PeerMatcher();
  PeerMatcher(PeerMatcher&&) noexcept;
  PeerMatcher& operator=(PeerMatcher&&) noexcept;

  /// Takes the pair, as 8-bit grey; not part of what is timed.
  void set_pair(const GreyImage& reference, const GreyImage& target);
  /// Matches it.
  void match();
  /// What was found: pixels, NaN invalid.
  Image<float> disparity() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace roadstereo::io
