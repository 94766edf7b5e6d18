#include "evaluate/damage_method.hpp"

#include <utility>

#include "given_disparity.hpp"

namespace roadstereo::cli {

std::vector<DamageMethod> damage_methods(const std::string& preset, const std::vector<GivenMaps>& maps) {
  std::vector<DamageMethod> methods{{preset, std::nullopt}};
  for (const GivenMaps& given : maps) methods.push_back({given.name, given});
  return methods;
}

FrameDamage find_damage_of(const DamageMethod& method, const StereoPair& pair, const std::string& frame) {
  FrameDamage found;
  if (!method.maps) {
    Pipeline pipeline(preset(method.name), pair.calibration);
    pipeline.process(pair.left.view(), pair.right.view(), found.frame);
    find_damage(found.frame, pair.calibration, pipeline.options().damage, 0, found.map);
    return found;
  }
  Inspection inspection;
  inspection.options = preset("default");
  inspection.pair = pair;
  inspection.pair.disparity = read_given_map(*method.maps, frame, pair.left.width, pair.left.height);
  use_given_disparity(inspection);
  found.frame = std::move(inspection.result);
  find_damage(found.frame, pair.calibration, inspection.options.damage, 0, found.map);
  return found;
}

}  // namespace roadstereo::cli
