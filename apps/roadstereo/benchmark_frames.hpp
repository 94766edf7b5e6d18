#pragma once

#include "pair_source.hpp"
#include "roadstereo/pipeline.hpp"

namespace roadstereo::cli {

/// Returns a synthetic road scene for images of that size; deterministic.
StereoPair synthetic_pair(int width, int height);

/// Returns the pair for OpenCV's matchers: grey, the target already transformed, so that all search the same
/// disparities.
struct PeerPair {
  GreyImage reference;
  GreyImage target;
};
PeerPair peer_pair(const StereoPair& pair, const PerspectiveShift& shift);

}  // namespace roadstereo::cli
