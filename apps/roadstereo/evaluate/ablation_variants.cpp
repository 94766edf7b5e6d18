#include "evaluate/ablation_variants.hpp"

namespace roadstereo::cli {
namespace {

std::vector<Variant> default_variants() {
  return {
      {"default", "default"},
      {"perspective off", "default", {}, false},
      {"whole-pixel shift", "default", {"perspective.shift=whole_pixel"}},
      {"shift without roll", "default", {"road_model.with_roll=false"}},
      {"rows not corrected", "default", {"correct_rows=false"}},
      {"search not narrowed", "default", {"narrow_search=false"}},
      {"no prior", "default", {"matcher.prior_slope=0"}},
      {"prior without road's pull", "default", {"coarse_search.road_pull=0"}},
      {"prior not smoothed along rows", "default", {"coarse_search.step_penalty=0", "coarse_search.jump_penalty=0"}},
      {"block 11x11", "default", {"matcher.block_radius=5"}},
      {"no aggregation", "default", {"matcher.aggregation_radius=0"}},
      {"no texture noise", "default", {"matcher.texture_noise=0", "coarse_search.texture_noise=0"}},
      {"no left-right check", "default", {"matcher.left_right_check=false"}},
      {"target volume matched too", "default", {"matcher.target_volume=true"}},
      {"no sub-pixel parabola", "default", {"matcher.sub_pixel=false"}},
      {"range ends dropped", "default", {"matcher.drop_range_ends=true"}},
      {"no refinement", "default", {"refinement.radius=0"}},
  };
}

/// The paper's own ideas taken away, then ours added to it.
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
      {"paper + prior", "paper", {"matcher.prior_slope=0.08", "coarse_search.road_pull=0.4"}},
      {"paper + texture noise", "paper", {"matcher.texture_noise=1"}},
      {"paper + block 5x5, wide window",
       "paper",
       {"matcher.block_radius=2", "matcher.aggregation_radius=6", "matcher.aggregation_step=2",
        "matcher.aggregation_shape=disc", "matcher.sigma_space=6", "matcher.sigma_colour=20"}},
      {"paper + range ends dropped", "paper", {"matcher.drop_range_ends=true"}},
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
