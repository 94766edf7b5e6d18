#include "map/map_provenance.hpp"

#include <fmt/format.h>

#include <string_view>

#include "flight/provenance.hpp"
#include "roadstereo/io/rig_bias_file.hpp"
#include "roadstereo/options.hpp"
#include "roadstereo/version.hpp"

namespace roadstereo::cli {
namespace {

std::string text_of(const SeverityScheme& scheme) {
  std::string text = scheme.name;
  for (const SeverityTable& table : scheme.tables) {
    text +=
        fmt::format(";{},{},{},{},{},{}", name_of(table.distress), name_of(table.unit), fmt::join(table.depths_m, " "),
                    fmt::join(table.diameters_m, " "), table.max_counted_m, table.area_of_one_m2);
    for (const std::vector<Severity>& row : table.classes) {
      for (const Severity severity : row) text += std::string(",") + name_of(severity);
    }
  }
  return text;
}

std::string_view bytes_of(const Image<std::uint8_t>& mask) {
  return mask.empty() ? std::string_view()
                      : std::string_view(reinterpret_cast<const char*>(mask.row(0)), mask.pixels());
}

}  // namespace

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
    made_with.emplace_back("content of the severities" + of, digest(text_of(pass.options.damage.severity)));
    made_with.emplace_back("content of the mask" + of, digest(bytes_of(pass.mask)));
    const SourceSettings& source = pass.source_settings;
    made_with.emplace_back("--layout" + of, source.layout);
    made_with.emplace_back("--topics" + of, fmt::format("{}", fmt::join(source.topics, " ")));
    made_with.emplace_back("--max-time-difference" + of, fmt::format("{}", source.max_time_difference_ms));
    made_with.emplace_back("--rate" + of, fmt::format("{}", source.rate_hz));
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
