#pragma once

#include "core/scratch.hpp"
#include "road/coarse_match.hpp"
#include "road/rig_prior.hpp"
#include "road/road_assessment.hpp"

namespace roadstereo {

/// A plane and what the whole picture says to it.
struct PlaneHypothesis {
  DisparityPlane plane;  ///< in full-size pixels
  double score = 0;      ///< evidence for the plane less evidence below it
};

/// Search planes by total evidence: a Hough transform over slope along the columns and a line in v-disparity space,
/// then a local search. Nothing has to be matched pixel by pixel: where noise or defocus leave a single block
/// undecided, the sum over all of them still decides. A plane gains where the pixels support its disparity and loses
/// where they lie beyond it, for nothing but damage lies below a road; lower rows count more. Best first, at most
/// `max_planes`, and none of them nearly equal. `limit` rejects walls, `prior` weighs the score in that order.
ScratchVector<PlaneHypothesis> search_planes(const CoarseMatches& coarse, const TiltLimit& limit, const RigPrior& prior,
                                             int max_planes, int threads);

}  // namespace roadstereo
