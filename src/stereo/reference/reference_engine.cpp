#include "stereo/reference/reference_engine.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/parallel.hpp"
#include "stereo/block_correlation.hpp"
#include "stereo/window.hpp"

namespace roadstereo {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// The matching costs c(p, d), or the aggregated costs E_d(p, d), of all pixels; NaN where p has no counterpart.
class CostVolume {
 public:
  CostVolume(int width, int height, int disparities)
      : width_(width),
        disparities_(disparities),
        costs_(
            static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * static_cast<std::size_t>(disparities),
            nan) {}

  double& operator()(int u, int v, int d) { return costs_[index(u, v, d)]; }
  double operator()(int u, int v, int d) const { return costs_[index(u, v, d)]; }

 private:
  std::size_t index(int u, int v, int d) const {
    const auto pixel = static_cast<std::size_t>(v) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(u);
    return pixel * static_cast<std::size_t>(disparities_) + static_cast<std::size_t>(d);
  }

  int width_;
  int disparities_;
  std::vector<double> costs_;
};

/// The two views of a pair and what is asked of them.
struct Scene {
  const MatchInput& input;
  const MatcherOptions& options;
  std::vector<Tap> window = window_taps(options);
  double support = effective_samples(options), floor = peak_floor(options);
  std::vector<int> first_column{};  ///< per row: first target column that the whole block of the row sees

  Scene(const MatchInput& match_input, const MatcherOptions& match_options)
      : input(match_input), options(match_options) {
    block_first_columns(input, block_row_radius(options), first_column);
  }

  int width() const { return input.reference.width(); }
  int height() const { return input.reference.height(); }
  int columns() const { return matched_pixels(width(), options); }
  int rows() const { return matched_pixels(height(), options); }
  bool in_reference(int u, int v) const { return u >= 0 && u < width() && v >= 0 && v < height(); }
  /// Whether target pixel (x, v) belongs to what is matched in the blocks around row `block_v`.
  bool in_target(int x, int v, int block_v) const {
    return in_reference(x, v) && x >= first_column[static_cast<std::size_t>(block_v)];
  }
};

/// c(p, d) of eq. (8): one minus the normalised cross-correlation of the blocks around p and p − [d, 0], over the part
/// N⁺ of the block that both views see.
double matching_cost(const Scene& scene, int u, int v, int d) {
  const int radius = scene.options.block_radius, row_radius = block_row_radius(scene.options);
  double n = 0, sum_ref = 0, sum_tar = 0, sum_ref_ref = 0, sum_tar_tar = 0, sum_ref_tar = 0;
  for (int qv = v - row_radius; qv <= v + row_radius; ++qv) {
    for (int qu = u - radius; qu <= u + radius; ++qu) {
      if (!scene.in_reference(qu, qv) || !scene.in_target(qu - d, qv, v)) continue;
      const double i_ref = scene.input.reference(qu, qv);
      const double i_tar = scene.input.target(qu - d, qv);
      n += 1;
      sum_ref += i_ref;
      sum_tar += i_tar;
      sum_ref_ref += i_ref * i_ref;
      sum_tar_tar += i_tar * i_tar;
      sum_ref_tar += i_ref * i_tar;
    }
  }
  const double mu_ref = sum_ref / n;
  const double mu_tar = sum_tar / n;
  const double variance_ref = sum_ref_ref / n - mu_ref * mu_ref;
  const double variance_tar = sum_tar_tar / n - mu_tar * mu_tar;
  // Without texture in a block nothing correlates: the cost is neutral. The camera's noise is added to the deviations,
  // so that texture that may be noise counts less; 0 is the paper's equation.
  if (variance_ref < min_variance || variance_tar < min_variance) return 1;
  const double noise = scene.options.ncc_noise_sigma * grey_scale;
  const double sigma_ref = std::sqrt(variance_ref + noise * noise);
  const double sigma_tar = std::sqrt(variance_tar + noise * noise);
  return (sigma_ref * sigma_tar + mu_ref * mu_tar) / (sigma_ref * sigma_tar) -
         sum_ref_tar / (n * sigma_ref * sigma_tar);
}

CostVolume compute_costs(const Scene& scene, int threads) {
  const int disparities = scene.input.disparities;
  CostVolume cost(scene.width(), scene.height(), disparities);
  parallel_rows(scene.height(), 1, threads, [&](int v, int, int) {
    for (int u = 0; u < scene.width(); ++u) {
      for (int d = 0; d < disparities && scene.in_target(u - d, v, v); ++d)
        cost(u, v, d) = matching_cost(scene, u, v, d);
    }
  });
  return cost;
}

/// ω(p, q) of eq. (30): the product of eqs. (31) and (32).
double bilateral_weight(ImageView<const std::int16_t> image, int u, int v, const Tap& tap,
                        const MatcherOptions& options) {
  const double difference = static_cast<double>(image(u, v) - image(u + tap.du, v + tap.dv)) / grey_scale;
  const double distance2 = tap.du * tap.du + tap.dv * tap.dv;
  const double omega0 = std::exp(-distance2 / (options.sigma_space * options.sigma_space));
  const double omega1 = std::exp(-difference * difference / (options.sigma_colour * options.sigma_colour));
  return omega0 * omega1;
}

/// E_d(p, d) of eq. (11) for every pixel of one view. `shift` is 0 for the reference view and 1 for the target view,
/// whose pixel x has the cost of reference pixel x + d: c_tar(p, d) = c_ref(p + [d, 0], d).
CostVolume aggregate(const Scene& scene, const CostVolume& cost, ImageView<const std::int16_t> image, int shift,
                     int threads) {
  const int disparities = scene.input.disparities;
  CostVolume aggregated(scene.width(), scene.height(), disparities);
  const auto cost_at = [&](int u, int v, int d) {
    const int column = u + shift * d;
    return scene.in_reference(u, v) && scene.in_reference(column, v) ? cost(column, v, d) : nan;
  };
  parallel_rows(scene.height(), 1, threads, [&](int v, int, int) {
    for (int u = 0; u < scene.width(); ++u) {
      for (int d = 0; d < disparities; ++d) {
        if (std::isnan(cost_at(u, v, d))) continue;
        double weighted = 0, weights = 0;
        for (const Tap& tap : scene.window) {
          const double c = cost_at(u + tap.du, v + tap.dv, d);
          if (std::isnan(c)) continue;
          const double omega = bilateral_weight(image, u, v, tap, scene.options);
          weighted += omega * c;
          weights += omega;
        }
        aggregated(u, v, d) = weighted / weights;
      }
    }
  });
  return aggregated;
}

const SearchRange& range_at(ImageView<const SearchRange> ranges, int u, int v) {
  return ranges(u / SearchRanges::tile_columns, v / SearchRanges::tile_rows);
}

/// Cost of the distance of a disparity from the prior: weight · min(distance, prior_truncation_px), weight =
/// prior_weight but where the smallest cost `best` is small (`prior_share`, stereo/sub_pixel.hpp).
double prior_term(const Scene& scene, const DisparityPriorView& prior, double best, int u, int v, int d) {
  if (prior.disparity.empty()) return 0;
  const int x = std::min(u / prior.factor, prior.disparity.width() - 1);
  const int y = std::min(v / prior.factor, prior.disparity.height() - 1);
  const double low = prior.low.empty() ? prior.disparity(x, y) : prior.low(x, y);
  const double high = prior.high.empty() ? prior.disparity(x, y) : prior.high(x, y);
  if (std::isnan(low)) return 0;
  const double distance = std::max({low - d, d - high, 0.0});
  const double weight = std::min(1.0, (best + double{prior_cost_offset}) / double{prior_full_cost});
  return weight * scene.options.prior_weight * std::min(distance, scene.options.prior_truncation_px);
}

/// Winner-take-all: the disparity of the smallest cost, −1 where there is none; the smaller disparity wins a tie.
Image<std::int16_t> take_winners(const Scene& scene, const CostVolume& energy, ImageView<const SearchRange> ranges,
                                 const DisparityPriorView& prior) {
  const int step = scene.options.pixel_step;
  Image<std::int16_t> winners(scene.columns(), scene.rows(), -1);
  for (int y = 0; y < winners.height(); ++y) {
    for (int x = 0; x < winners.width(); ++x) {
      const int u = x * step, v = y * step;
      const SearchRange searched = range_at(ranges, u, v);
      double smallest = std::numeric_limits<double>::infinity();
      for (int d = searched.first; d < searched.end; ++d) {
        if (energy(u, v, d) < smallest) smallest = energy(u, v, d);
      }
      double best = std::numeric_limits<double>::infinity();
      for (int d = searched.first; d < searched.end; ++d) {
        const double regularised = energy(u, v, d) + prior_term(scene, prior, smallest, u, v, d);
        if (regularised < best) {
          best = regularised;
          winners(x, y) = static_cast<std::int16_t>(d);
        }
      }
    }
  }
  return winners;
}

/// Eq. (12) at pixel (x, y) of the maps. The shift of the perspective transformation depends on the target pixel alone,
/// so it cancels here and the check on residual disparities is the check on the original ones.
bool consistent(const MatchMaps& maps, int x, int y, const MatcherOptions& options) {
  const int d = maps.winner(x, y);
  const int met = maps.target_winner(x * options.pixel_step - d, y);
  return met >= 0 && std::abs(d - met) <= options.lr_max_diff_px;
}

/// A sub-pixel disparity and its variance.
struct Refined {
  double disparity = nan;
  double variance = std::numeric_limits<double>::infinity();
};

/// Eq. (13), or a Gaussian, on the aggregated costs, and the variance that they tell of (stereo/window.hpp). A winner
/// at the end of its range has no neighbour on one side; one that leans on the prior need not be a minimum of the
/// costs.
Refined refine(const Scene& scene, const CostVolume& energy, const SearchRange& searched, int u, int v, int d) {
  Refined refined;
  const bool first = d == searched.first;
  const bool last = d + 1 == searched.end || std::isnan(energy(u, v, d + 1));
  if (first || last) {
    if (!scene.options.reject_range_boundary) refined.disparity = d;
    return refined;
  }
  const double before = energy(u, v, d - 1), best = energy(u, v, d), after = energy(u, v, d + 1);
  const double curvature = before + after - 2 * best;
  refined.disparity = d;
  if (curvature <= double{min_curvature}) return refined;
  double vertex = (before - after) / (2 * curvature);
  if (scene.options.peak_fit == PeakFit::gaussian) {
    const auto log_of = [&](double cost) { return -std::log(std::max(1 - cost, 0.0) + scene.floor); };
    const double sharpness = log_of(before) + log_of(after) - 2 * log_of(best);
    vertex = (log_of(before) - log_of(after)) / (2 * std::max(sharpness, double{min_curvature}));
  }
  const double noise = 2 * std::max(best, 0.0) / (scene.support * curvature);
  const double max_offset = noise < double{low_noise_variance} ? double{low_noise_truncation_px} : 0.5;
  const double offset = std::clamp(vertex, -max_offset, max_offset);
  if (scene.options.sub_pixel) refined.disparity = d + offset;
  refined.variance = noise + (vertex - offset) * (vertex - offset);
  return refined;
}

class ReferenceEngine final : public StereoEngine {
 public:
  explicit ReferenceEngine(int threads) : threads_(resolve_threads(threads)) {}

  void match(const MatchInput& input, const MatcherOptions& options, MatchMaps& maps) override {
    validate(input);
    options.validate();
    const Scene scene{input, options};
    const CostVolume cost = compute_costs(scene, threads_);
    const CostVolume energy_ref = aggregate(scene, cost, input.reference, 0, threads_);
    SearchRanges all;
    all.assign(scene.width(), scene.height(), input.disparities);
    const SearchRangeViews ranges = input.ranges.empty() ? all.views() : input.ranges;
    maps.winner = take_winners(scene, energy_ref, ranges.reference, input.prior);
    if (options.match_both_views) {
      maps.target_winner = take_winners(scene, aggregate(scene, cost, input.target, 1, threads_), ranges.target, {});
    } else {
      maps.target_winner.resize(scene.width(), scene.rows());
      for (int y = 0; y < scene.rows(); ++y) project_winners(maps.winner, y, options.pixel_step, maps.target_winner);
    }
    maps.disparity.assign(scene.columns(), scene.rows(), std::numeric_limits<float>::quiet_NaN());
    maps.variance.assign(scene.columns(), scene.rows(), std::numeric_limits<float>::infinity());
    for (int y = 0; y < scene.rows(); ++y) {
      for (int x = 0; x < scene.columns(); ++x) {
        if (maps.winner(x, y) < 0) continue;
        const bool occluded = options.left_right_check && !consistent(maps, x, y, options);
        if (occluded && options.occlusion_sigma_px == 0) continue;
        const int u = x * options.pixel_step, v = y * options.pixel_step;
        const Refined refined = refine(scene, energy_ref, range_at(ranges.reference, u, v), u, v, maps.winner(x, y));
        maps.disparity(x, y) = static_cast<float>(refined.disparity);
        const double added_variance = occluded ? options.occlusion_sigma_px * options.occlusion_sigma_px : 0;
        maps.variance(x, y) = static_cast<float>(refined.variance + added_variance);
      }
    }
  }

 private:
  int threads_;
};

}  // namespace

std::unique_ptr<StereoEngine> make_reference_engine(int threads) {
  return std::make_unique<ReferenceEngine>(threads);
}

}  // namespace roadstereo
