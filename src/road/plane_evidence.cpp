#include "road/plane_evidence.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "core/parallel.hpp"
#include "road/downsampled_plane.hpp"
#include "road/line_sums.hpp"

namespace roadstereo {
namespace {

constexpr float beyond_weight = 3.0f;    ///< of evidence below the plane, against support along it
constexpr float beyond_margin = 1.5f;    ///< pixels of the downsampled image that the road may be uneven
constexpr double base_row_weight = 0.2;  ///< of the uppermost row; the lowest has this and 1
constexpr double slope_step = 2.0;       ///< pixels of disparity at the left and right border
constexpr double least_share = 0.5;      ///< of the picture that a plane's evidence is divided by: what is seen in
                                         ///< a few rows only is no road
constexpr int bottom_steps = 40, top_steps = 56;
constexpr int row_step = 2;          ///< every second row of cells is enough to find a line
constexpr double lowest_top = -0.6;  ///< disparity of the uppermost row, as a share of the largest

/// A plane by its disparities at the left and right end of the lowest row of cells and in the middle of the uppermost.
struct ThreePoints {
  std::array<double, 3> d;  ///< bottom left, bottom right, top centre

  DisparityPlane plane(const PlaneEvidence& grid) const {
    const double left = grid.column(0), right = grid.column(grid.columns() - 1);
    const double top = grid.row(0), bottom = grid.row(grid.rows() - 1);
    const double a2 = right > left ? (d[1] - d[0]) / (right - left) : 0;
    const double middle = 0.5 * (d[0] + d[1]);
    const double a1 = bottom > top ? (middle - d[2]) / (bottom - top) : 0;
    return plane_to_full_size({middle - a1 * bottom - a2 * grid.middle_column(), a1, a2}, grid.factor());
  }
};

struct Candidate {
  ThreePoints points{};
  double score = -std::numeric_limits<double>::infinity();
  double weight = 1;  ///< of the score in comparisons
};

/// Rows of the grid with the columns summed along one slope: the v-disparity image sheared by it.
class ShearedRows {
 public:
  /// `values` is memory for rows × disparities values.
  ShearedRows(const PlaneEvidence& grid, double slope, float* values)
      : image_{values, grid.rows(), grid.disparities()} {
    std::fill_n(values, size(grid), 0.0f);
    for (int c = 0; c < grid.columns(); ++c) {
      const double offset = slope * (grid.column(c) - grid.middle_column());
      const int whole = static_cast<int>(std::floor(offset));
      const float share = static_cast<float>(offset - whole);
      const int first = std::max(0, -whole), last = std::min(image_.disparities, image_.disparities - 1 - whole);
      for (int r = 0; r < grid.rows(); ++r) {
        const float* in = grid.values(r, c) + whole;
        float* out = values + static_cast<std::ptrdiff_t>(r) * image_.disparities;
        for (int d = first; d < last; ++d) out[d] += (1 - share) * in[d] + share * in[d + 1];
      }
    }
  }

  static std::size_t size(const PlaneEvidence& grid) {
    return static_cast<std::size_t>(grid.rows()) * static_cast<std::size_t>(grid.disparities());
  }
  const VDisparity& image() const { return image_; }

 private:
  VDisparity image_;
};

/// The best lines of one slope that can be a road's, one for each disparity of the lowest row, and the best other one.
void search_lines(const PlaneEvidence& grid, const ShearedRows& sheared, double slope, const TiltLimit& limit,
                  Candidate* roads, Candidate& wall) {
  const double span = slope * (grid.column(grid.columns() - 1) - grid.middle_column());
  const int last_row = grid.rows() - 1;
  std::array<double, top_steps + 1> tops;
  std::array<float, top_steps + 1 + line_sums_guard> steps{}, sums;
  for (std::size_t t = 0; t < tops.size(); ++t) {
    tops[t] = grid.disparities() * (lowest_top + (1 - lowest_top) * static_cast<double>(t) / top_steps);
  }
  for (int b = 0; b < bottom_steps; ++b) {
    const double bottom = (b + 1.0) * grid.disparities() / bottom_steps;
    for (std::size_t t = 0; t < tops.size(); ++t) steps[t] = static_cast<float>((bottom - tops[t]) / last_row);
    sum_along_lines(sheared.image(), static_cast<float>(bottom), steps.data(), top_steps + 1, row_step, sums.data());
    for (std::size_t t = 0; t < tops.size(); ++t) {
      if (static_cast<double>(sums[t]) <= std::min(roads[b].score, wall.score)) continue;
      const ThreePoints points{{bottom - span, bottom + span, tops[t]}};
      Candidate& best = limit.can_be_road(points.plane(grid)) ? roads[b] : wall;
      if (static_cast<double>(sums[t]) > best.score) best = {points, sums[t], 1};
    }
  }
}

/// Coordinate descent over the three points with a step that is halved.
void refine_plane(const PlaneEvidence& grid, const TiltLimit& limit, Candidate& candidate) {
  constexpr double first_step = 1.0;
  constexpr int halvings = 4;
  const auto score = [&](const DisparityPlane& plane) { return limit.pose_weight(plane) * grid.of_plane(plane); };
  candidate.score = score(candidate.points.plane(grid));
  double step = first_step;
  for (int halving = 0; halving < halvings; ++halving, step /= 2) {
    for (bool moved = true; moved;) {
      moved = false;
      for (std::size_t i = 0; i < 3; ++i) {
        for (const double change : {-step, step}) {
          Candidate next = candidate;
          next.points.d[i] += change;
          const DisparityPlane plane = next.points.plane(grid);
          next.score = score(plane);
          if (next.score <= candidate.score || !limit.can_be_road(plane)) continue;
          candidate = next;
          moved = true;
        }
      }
    }
  }
}

bool nearly_equal(const ThreePoints& a, const ThreePoints& b, double tolerance) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (std::abs(a.d[i] - b.d[i]) > tolerance) return false;
  }
  return true;
}

/// The best candidates that differ, best first.
ScratchVector<Candidate> choose(ScratchVector<Candidate>& candidates, std::size_t count, double tolerance) {
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.weight * a.score > b.weight * b.score; });
  auto chosen = scratch_vector<Candidate>();
  for (const Candidate& candidate : candidates) {
    if (chosen.size() == count || candidate.score <= 0) break;
    const bool known = std::any_of(chosen.begin(), chosen.end(), [&](const Candidate& other) {
      return nearly_equal(candidate.points, other.points, tolerance);
    });
    if (!known) chosen.push_back(candidate);
  }
  return chosen;
}

}  // namespace

PlaneEvidence::PlaneEvidence(const CoarseMatches& coarse, Rows order)
    : rows_(coarse.evidence.rows()),
      columns_(coarse.evidence.columns()),
      disparities_(coarse.evidence.disparities()),
      first_row_(coarse.first_row),
      factor_(coarse.factor),
      pixels_(coarse.pixels()),
      values_(
          scratch_vector<float>(static_cast<std::size_t>(rows_ * columns_) * static_cast<std::size_t>(disparities_))) {
  const float full_weight = 1 / (full_weight_share * static_cast<float>(disparities_));
  constexpr auto margin = static_cast<int>(beyond_margin + 1);
  constexpr float share = static_cast<float>(margin) - beyond_margin;
  for (int r = 0; r < rows_; ++r) {
    const double lower = row(r) / coarse.height;
    const auto weight = static_cast<float>(base_row_weight + lower * lower);
    const int seen = order == Rows::as_seen ? r : rows_ - 1 - r;
    for (int c = 0; c < columns_; ++c) {
      const float *support = coarse.evidence.support(seen, c), *beyond = coarse.evidence.beyond(seen, c);
      float* value = values_.data() + at(r, c);
      const auto supported = [&](int d) {
        return std::min(1.0f, static_cast<float>(d) * full_weight) * std::max(0.0f, support[d]);
      };
      for (int d = 0; d < std::min(margin, disparities_); ++d) value[d] = weight * supported(d);
      for (int d = margin; d < disparities_; ++d) {
        const float below = (1 - share) * beyond[d - margin] + share * beyond[d - margin + 1];
        value[d] = weight * (supported(d) - beyond_weight * below);
      }
    }
  }
}

double PlaneEvidence::of_plane(const DisparityPlane& full_size) const {
  const DisparityPlane plane = downsample_plane(full_size, factor_);
  const double sum = sum_along_plane(
      {values_.data(), rows_, columns_, disparities_}, static_cast<float>(plane.disparity(column(0), row(0))),
      static_cast<float>(plane.a1 * evidence_rows), static_cast<float>(plane.a2 * evidence_columns));
  return sum / (pixels_ * std::max(share_in_front(plane), least_share));
}

double PlaneEvidence::share_in_front(const DisparityPlane& plane) const {
  double rows_in_front = 0;
  for (int r = 0; r < rows_; ++r) {
    const double left = plane.disparity(column(0), row(r)), right = plane.disparity(column(columns_ - 1), row(r));
    const double nearest = std::max(left, right), farthest = std::min(left, right);
    if (nearest > 0) rows_in_front += farthest >= 0 ? 1 : nearest / (nearest - farthest);
  }
  return rows_in_front / rows_;
}

PlaneSearchResult search_planes(const PlaneEvidence& evidence, const TiltLimit& limit,
                                FunctionRef<double(const DisparityPlane&)> prior, double max_slope, int max_planes,
                                int threads) {
  PlaneSearchResult result;
  if (evidence.rows() < 2 || evidence.columns() < 2 || evidence.disparities() < 4) return result;
  const double half_width = 0.5 * (evidence.column(evidence.columns() - 1) - evidence.column(0));
  const int half_slopes = static_cast<int>(max_slope * half_width / slope_step), slopes = 2 * half_slopes + 1;
  auto candidates = scratch_vector<Candidate>(static_cast<std::size_t>(slopes) * bottom_steps);
  auto walls = scratch_vector<Candidate>(static_cast<std::size_t>(slopes));
  auto sheared =
      scratch_vector<float>(static_cast<std::size_t>(resolve_threads(threads)) * ShearedRows::size(evidence));
  parallel_for(slopes, threads, [&](int i, int worker) {
    const double slope = (i - half_slopes) * slope_step / half_width;
    const ShearedRows rows(evidence, slope,
                           sheared.data() + static_cast<std::size_t>(worker) * ShearedRows::size(evidence));
    search_lines(evidence, rows, slope, limit, candidates.data() + static_cast<std::ptrdiff_t>(i) * bottom_steps,
                 walls[static_cast<std::size_t>(i)]);
  });
  const auto weight = [&](const DisparityPlane& plane) { return limit.pose_weight(plane) * prior(plane); };
  for (Candidate& candidate : candidates) {
    if (candidate.score > 0) candidate.weight = weight(candidate.points.plane(evidence));
  }
  constexpr std::size_t refined = 8;
  ScratchVector<Candidate> best = choose(candidates, refined, 2 * slope_step);
  parallel_for(static_cast<int>(best.size()), threads, [&](int i, int) {
    Candidate& candidate = best[static_cast<std::size_t>(i)];
    refine_plane(evidence, limit, candidate);
    const DisparityPlane plane = candidate.points.plane(evidence);
    candidate.score = evidence.of_plane(plane);
    candidate.weight = weight(plane);
  });
  for (const Candidate& candidate : choose(best, static_cast<std::size_t>(max_planes), slope_step)) {
    result.roads.push_back({candidate.points.plane(evidence), candidate.score});
  }
  for (const Candidate& wall : choose(walls, 1, slope_step)) {
    result.wall_evidence = evidence.of_plane(wall.points.plane(evidence));
  }
  return result;
}

double ceiling_evidence(const CoarseMatches& coarse, const TiltLimit& limit, int threads) {
  const PlaneEvidence evidence(coarse, PlaneEvidence::Rows::upside_down);
  const auto any = [](const DisparityPlane&) { return 1.0; };
  constexpr double level = 0;
  constexpr int max_planes = 1;
  for (const PlaneHypothesis& ceiling : search_planes(evidence, limit, any, level, max_planes, threads).roads) {
    if (!limit.can_be_road(evidence.upside_down(ceiling.plane))) return ceiling.evidence;
  }
  return 0;
}

}  // namespace roadstereo
