#pragma once

#include "core/function_ref.hpp"
#include "core/scratch.hpp"
#include "road/coarse_match.hpp"
#include "road/road_assessment.hpp"

namespace roadstereo {

/// Share of the largest disparity from which a cell counts in full as evidence: the far road is a small patch that any
/// surface there supports.
inline constexpr float full_weight_share = 0.15f;

/// A plane and the evidence of the whole image for it.
struct PlaneHypothesis {
  DisparityPlane plane;  ///< in full-size pixels
  double evidence = 0;   ///< RoadModelEstimate::evidence
};

/// Evidence of the cells of a downsampled pair for planes. A plane gains where pixels support its disparity and loses
/// where they lie beyond it, since nothing but damage lies below a road. Objects in front of it do not count. Lower
/// rows count more.
class PlaneEvidence {
 public:
  enum class Rows { as_seen, upside_down };
  explicit PlaneEvidence(const CoarseMatches& coarse, Rows order = Rows::as_seen);

  int rows() const { return rows_; }
  int columns() const { return columns_; }
  int disparities() const { return disparities_; }
  int factor() const { return factor_; }
  double row(int r) const { return first_row_ + evidence_rows * (r + 0.5) - 0.5; }
  double column(int c) const { return evidence_columns * (c + 0.5) - 0.5; }
  double middle_column() const { return 0.5 * (column(0) + column(columns_ - 1)); }
  const float* values(int r, int c) const { return values_.data() + at(r, c); }

  /// Mean evidence for a plane per pixel in which it would be visible, about −1 … 2. It is a mean because a plane that
  /// reaches higher up crosses more houses and cars, which give some evidence for any plane. The plane is in full-size
  /// pixels.
  double of_plane(const DisparityPlane& plane) const;
  /// The plane as the rows show it in the opposite order.
  DisparityPlane upside_down(const DisparityPlane& plane) const {
    const double rows_sum = factor_ * (row(0) + row(rows_ - 1) + 1) - 1;
    return {plane.a0 + plane.a1 * rows_sum, -plane.a1, plane.a2};
  }

 private:
  /// Share of the picture where a plane of the downsampled image lies in front of the camera.
  double share_in_front(const DisparityPlane& plane) const;
  std::size_t at(int r, int c) const {
    return static_cast<std::size_t>(r * columns_ + c) * static_cast<std::size_t>(disparities_);
  }

  int rows_, columns_, disparities_, first_row_, factor_;
  double pixels_;
  ScratchVector<float> values_;
};

/// What a search found.
struct PlaneSearchResult {
  ScratchVector<PlaneHypothesis> roads = scratch_vector<PlaneHypothesis>();  ///< best first, none of them nearly equal
  double wall_evidence = 0;  ///< the most evidence for a plane that cannot be a road
};

/// Search planes by total evidence: a Hough transform over slope along the columns and a line in v-disparity space,
/// then a local search. Nothing has to be matched pixel by pixel: where noise or defocus leave a single block
/// undecided, the sum over all of them still decides. At most `max_planes` roads. `limit` tells them from walls; the
/// weights of the tilt and of `prior` count in their order, not in the evidence. Slopes along the columns are searched
/// up to `max_slope`, disparities per column.
PlaneSearchResult search_planes(const PlaneEvidence& evidence, const TiltLimit& limit,
                                FunctionRef<double(const DisparityPlane&)> prior, double max_slope, int max_planes,
                                int threads);
inline constexpr double road_max_slope = 0.3;  ///< disparities per column

/// The most evidence for a plane above the camera, which no road can be; 0 where there is none.
double ceiling_evidence(const CoarseMatches& coarse, const TiltLimit& limit, int threads);

}  // namespace roadstereo
