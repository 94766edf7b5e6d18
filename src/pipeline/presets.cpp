#include "core/parallel.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/pipeline.hpp"

namespace roadstereo {
namespace {

/// The constants of the paper.
PipelineOptions paper_preset() {
  PipelineOptions options;
  options.correct_rows = false;
  options.road_model.with_roll = false;  // eq. (4): Δu depends on v alone
  options.perspective.shift = ShiftPrecision::whole_pixel;
  options.coarse_search.road_prior_height_m = 0;
  options.matcher.prior_weight = 0;  // the costs alone decide
  options.matcher.match_both_views = true;
  options.matcher.adapt_support = false;
  options.matcher.pixel_step = 1;
  options.matcher.block_radius = 5;  // 120-connected system
  options.deblock = false;
  options.equalise_blur = false;
  options.matcher.block_aspect = 1;
  options.matcher.aggregation_radius = 5;
  options.matcher.aggregation_aspect = 1;
  options.matcher.aggregation_step = 1;
  options.matcher.aggregation_shape = WindowShape::square;
  options.matcher.sigma_space = 1.5;    // σ0
  options.matcher.sigma_colour = 5.5;   // σ1
  options.matcher.ncc_noise_sigma = 0;  // eq. (8) as written
  options.matcher.lr_max_diff_px = 1;   // δr
  options.matcher.occlusion_sigma_px = 0;
  options.matcher.peak_fit = PeakFit::parabola;  // eq. (13)
  options.matcher.reject_range_boundary = false;
  options.lucas_kanade.radius = 0;
  options.off_road.max_sigma_px = 0;
  options.refinement.radius = 0;
  options.refinement.max_sigma_px = 1000;  // the left-right check alone decides
  options.roll.solver = RollSolver::gradient_descent;
  options.roll.initial_lambda = 10;  // λ(0)
  return options;
}

/// Highest speed that is still more accurate than semi-global matching on roads: block matching by correlation with the
/// prior of a very coarse search.
PipelineOptions fast_preset() {
  PipelineOptions options;
  options.coarse_search.factor = 4;
  options.coarse_search.road_prior_truncation = 3;  // gives disparities off the road, right or wrong
  options.matcher.adapt_support = false;            // its block is large already
  options.matcher.reject_range_boundary = true;
  options.matcher.occlusion_sigma_px = 0;
  options.matcher.block_radius = 8;
  options.matcher.block_aspect = 0.4;
  options.matcher.aggregation_radius = 0;
  options.lucas_kanade.radius = 0;
  options.off_road.max_sigma_px = 0;
  options.refinement.radius = 0;
  options.refinement.max_sigma_px = 1000;  // the left-right check alone decides
  return options;
}

}  // namespace

const std::vector<std::string>& preset_names() {
  static const std::vector<std::string> names{"default", "fast", "paper"};
  return names;
}

PipelineOptions preset(const std::string& name) {
  if (name == "default") return {};
  if (name == "fast") return fast_preset();
  if (name == "paper") return paper_preset();
  fail("there is no preset called '", name, "'; there are: default, fast, paper");
}

void PipelineOptions::validate() const {
  if (!(white_level >= 0 && white_level <= 65535)) {
    fail("white_level is ", white_level, "; it must be between 0 (the sample type's largest) and 65535");
  }
  resolve_threads(threads);
  resolve_engine_name(engine);
  road_model.validate();
  perspective.validate();
  coarse_search.validate();
  matcher.validate();
  lucas_kanade.validate();
  if (perspective.shift == ShiftPrecision::whole_pixel && lucas_kanade.radius > 0) {
    fail("perspective.shift is whole_pixel; lucas_kanade.radius must be 0 with it, but is ", lucas_kanade.radius);
  }
  off_road.validate();
  refinement.validate();
  roll.validate();
  damage.validate();
  if (rig_bias) rig_bias->validate();
}

}  // namespace roadstereo
