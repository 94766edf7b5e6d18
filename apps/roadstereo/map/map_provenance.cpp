#include "map/map_provenance.hpp"

#include <fmt/format.h>

#include "flight/provenance.hpp"
#include "roadstereo/io/rig_bias_file.hpp"
#include "roadstereo/options.hpp"
#include "roadstereo/version.hpp"

namespace roadstereo::cli {

io::Provenance provenance(const MapPlan& plan) {
  io::Provenance made_with{{"version", version},
                           {"--crs", plan.crs},
                           {"--cell", fmt::format("{}", plan.cell_m)},
                           {"--every", std::to_string(plan.every)}};
  for (std::size_t k = 0; k < plan.passes.size(); ++k) {
    const MapPass& pass = plan.passes[k];
    const std::string of = fmt::format(" of recording {}", k);
    made_with.emplace_back("source" + of, fmt::format("{}", fmt::join(pass.source, " ")));
    made_with.emplace_back("content of the calibration" + of, content_digest(pass.calibration));
    made_with.emplace_back("content of the trajectory" + of, content_digest({pass.trajectory}));
    made_with.emplace_back("--day" + of, pass.day);
    made_with.emplace_back("rig bias" + of,
                           pass.options.rig_bias ? io::rig_bias_json(*pass.options.rig_bias) : std::string());
    for (const OptionText& option : list_options(pass.options)) {
      if (option.key != "threads") made_with.emplace_back(option.key + of, option.value);
    }
  }
  made_with.emplace_back("number of recordings", std::to_string(plan.passes.size()));
  return made_with;
}

}  // namespace roadstereo::cli
