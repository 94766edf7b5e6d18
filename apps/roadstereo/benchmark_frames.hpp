#pragma once

#include "pair_source.hpp"
#include "roadstereo/pipeline.hpp"

namespace roadstereo::cli {

/// A synthetic road seen by a rig with a camera of the given size; always the same.
StereoPair synthetic_pair(int width, int height);

/// The pair as OpenCV's matchers get it: grey, the target already transformed, so that both search the same
/// disparities.
struct PeerPair {
  GreyImage reference;
  GreyImage target;
};
PeerPair peer_pair(const StereoPair& pair, const PerspectiveShift& shift);

}  // namespace roadstereo::cli
