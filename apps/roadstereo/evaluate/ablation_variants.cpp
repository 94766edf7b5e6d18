#include "evaluate/ablation_variants.hpp"

namespace roadstereo::cli {
namespace {

std::vector<Variant> default_variants() {
  return {
      {"default", "default"},
      {"perspective off", "default", {}, false},
      {"whole-pixel shift, no Lucas–Kanade step",
       "default",
       {"perspective.shift=whole_pixel", "lucas_kanade.radius=0"}},
      {"shift without roll", "default", {"road_model.with_roll=false"}},
      {"rows not corrected", "default", {"correct_rows=false"}},
      {"search not narrowed", "default", {"narrow_search=false"}},
      {"no prior", "default", {"matcher.prior_weight=0"}},
      {"no road prior", "default", {"coarse_search.road_prior_height_m=0"}},
      {"no scanline optimisation of the prior",
       "default",
       {"coarse_search.step_penalty=0", "coarse_search.jump_penalty=0"}},
      {"support not adapted", "default", {"matcher.adapt_support=false"}},
      {"block 5x5, lower where foreshortened", "default", {"matcher.block_radius=2", "matcher.block_aspect=1"}},
      {"block 11x11, lower where foreshortened", "default", {"matcher.block_radius=5", "matcher.block_aspect=1"}},
      {"no aggregation", "default", {"matcher.aggregation_radius=0"}},
      {"no texture noise", "default", {"matcher.ncc_noise_sigma=0", "coarse_search.ncc_noise_sigma=0"}},
      {"no left-right check", "default", {"matcher.left_right_check=false"}},
      {"every pixel matched", "default", {"matcher.pixel_step=1"}},
      {"target volume matched too", "default", {"matcher.pixel_step=1", "matcher.match_both_views=true"}},
      {"no sub-pixel disparities", "default", {"matcher.sub_pixel=false"}},
      {"sub-pixel parabola", "default", {"matcher.peak_fit=parabola"}},
      {"range ends dropped", "default", {"matcher.reject_range_boundary=true"}},
      {"no refinement", "default", {"refinement.radius=0"}},
      {"all kept off the road", "default", {"off_road.max_sigma_px=0"}},
  };
}

/// The paper without its components, then with components of the default preset.
std::vector<Variant> paper_variants() {
  return {
      {"paper", "paper"},
      {"paper, perspective off", "paper", {}, false},
      {"paper, no aggregation", "paper", {"matcher.aggregation_radius=0"}},
      {"paper, no left-right check", "paper", {"matcher.left_right_check=false"}},
      {"paper, no sub-pixel parabola", "paper", {"matcher.sub_pixel=false"}},
      {"paper + sub-pixel shift", "paper", {"perspective.shift=sub_pixel"}},
      {"paper + shift with roll", "paper", {"road_model.with_roll=true"}},
      {"paper + rows corrected", "paper", {"correct_rows=true"}},
      {"paper + prior", "paper", {"matcher.prior_weight=0.08", "coarse_search.road_prior_height_m=0.15"}},
      {"paper + texture noise", "paper", {"matcher.ncc_noise_sigma=1"}},
      {"paper + block 5x5, wide window",
       "paper",
       {"matcher.block_radius=2", "matcher.aggregation_radius=6", "matcher.aggregation_step=2",
        "matcher.aggregation_shape=disc", "matcher.sigma_space=6", "matcher.sigma_colour=20"}},
      {"paper + Gaussian peak", "paper", {"matcher.peak_fit=gaussian"}},
      {"paper + range ends dropped", "paper", {"matcher.reject_range_boundary=true"}},
      {"paper + refinement", "paper", {"refinement.radius=8"}},
  };
}

}  // namespace

const std::vector<Variant>& ablation_variants() {
  static const std::vector<Variant> variants = [] {
    std::vector<Variant> all = default_variants();
    const std::vector<Variant> paper = paper_variants();
    all.insert(all.end(), paper.begin(), paper.end());
    return all;
  }();
  return variants;
}

std::size_t base_of(std::size_t variant) {
  const std::vector<Variant>& variants = ablation_variants();
  std::size_t base = variant;
  while (variants[base].name != variants[base].preset) --base;
  return base;
}

}  // namespace roadstereo::cli
