#pragma once

#include "core/downsample.hpp"
#include "road/masked_blocks.hpp"
#include "road/plane_match.hpp"
#include "road/road_assessment.hpp"
#include "road/road_search.hpp"

// The search of correspondences around a supposed plane, and the robust fit to them.

namespace roadstereo {

/// The pair as the fine search sees it: at full size, or downsampled.
class FinePair {
 public:
  FinePair(ImageView<const std::int16_t> left, ImageView<const std::int16_t> right, ImageView<const std::uint8_t> mask,
           int factor)
      : factor_(factor), masked_(mask, factor_) {
    // At full size there is nothing to downsample, and nothing to copy.
    const std::size_t size = factor_ > 1 ? left.pixels() / static_cast<std::size_t>(factor_ * factor_) : 0;
    pixels_.resize(2 * size);
    left_ = downsampled(left, pixels_.data());
    right_ = downsampled(right, pixels_.data() + size);
  }

  ImageView<const std::int16_t> left() const { return left_; }
  ImageView<const std::int16_t> right() const { return right_; }
  const MaskedBlocks& masked() const { return masked_; }
  int factor() const { return factor_; }

 private:
  ImageView<const std::int16_t> downsampled(ImageView<const std::int16_t> image, std::int16_t* pixels) const {
    if (factor_ == 1) return image;
    const ImageView<std::int16_t> small(pixels, image.width() / factor_, image.height() / factor_);
    downsample(image, factor_, small);
    return small;
  }

  int factor_;
  MaskedBlocks masked_;
  ScratchVector<std::int16_t> pixels_ = scratch_vector<std::int16_t>();
  ImageView<const std::int16_t> left_, right_;
};

/// What the fine search around a plane and a robust fit leave.
struct Refinement {
  PlaneFitStatistics evidence;
  ScratchVector<DisparityPoint> points = scratch_vector<DisparityPoint>();  ///< full-size coordinates
};

/// `match_along_plane` or `match_cells_along_plane`.
using PlaneMatcher = decltype(match_along_plane);

ScratchVector<DisparityPoint> points_to_full_resolution(ScratchVector<DisparityPoint> points, int factor);

/// Correspondences around a plane, in full-size pixels, and the plane that fits them.
Refinement refine_road(const FinePair& pair, const DisparityPlane& plane, PlaneMatcher match, const FineSearch& search,
                       bool with_roll, int threads);

/// What two searches by the same blocks find: wide around a supposed plane, then close around where the first finds it.
struct TwoSearches {
  Refinement wide, close;

  TwoSearches(const FinePair& pair, const DisparityPlane& plane, PlaneMatcher match, const FineSearch& first,
              const FineSearch& second, bool with_roll, int threads)
      : wide(refine_road(pair, plane, match, first, with_roll, threads)) {
    if (wide.evidence.found) close = refine_road(pair, wide.evidence.plane, match, second, with_roll, threads);
  }
  const PlaneFitStatistics& last() const { return wide.evidence.found ? close.evidence : wide.evidence; }
};

/// The plane that most of the image around `plane` supports, by RANSAC over cells of equal size; `plane` where there is
/// none. Single blocks match where the texture is: on a pavement or a verge rather than on a smooth road, so that the
/// plane tips over.
DisparityPlane fit_evenly(const FinePair& pair, const DisparityPlane& plane, const TiltLimit& limit, bool with_roll,
                          int threads);

}  // namespace roadstereo
