#include "evaluate/damage_method.hpp"

#include <utility>

#include "find_damage_or_warn.hpp"
#include "given_disparity.hpp"

namespace roadstereo::cli {

std::vector<DamageMethod> damage_methods(const std::string& preset, const std::vector<GivenMaps>& maps) {
  std::vector<DamageMethod> methods{{preset, std::nullopt}};
  for (const GivenMaps& given : maps) methods.push_back({given.name, given});
  return methods;
}

namespace {

/// None where there is no road, as `inspect` reports it.
void find_damage_or_none(const StereoPair& pair, const DamageOptions& options, FrameDamage& found) {
  PairHealth health;
  std::vector<std::string> warnings;
  find_damage_or_warn(found.frame, pair.calibration, options, 0, found.map, health, warnings);
}

}  // namespace

FrameDamage find_damage_of(const DamageMethod& method, const StereoPair& pair, const std::string& frame) {
  FrameDamage found;
  if (!method.maps) {
    PipelineOptions options = preset(method.name);
    options.white_level = pair.white_level;
    Pipeline pipeline(options, pair.calibration);
    pipeline.process(pair.left.view(), pair.right.view(), found.frame);
    find_damage_or_none(pair, pipeline.options().damage, found);
    return found;
  }
  Inspection inspection;
  inspection.options = preset("default");
  inspection.options.white_level = pair.white_level;
  inspection.pair = pair;
  inspection.pair.disparity = read_given_map(*method.maps, frame, pair.left.width, pair.left.height);
  use_given_disparity(inspection);
  found.frame = std::move(inspection.result);
  find_damage_or_none(pair, inspection.options.damage, found);
  return found;
}

}  // namespace roadstereo::cli
