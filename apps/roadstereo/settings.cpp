#include "settings.hpp"

#include "roadstereo/error.hpp"
#include "roadstereo/options.hpp"

namespace roadstereo::cli {

std::pair<std::string, std::string> split_setting(const std::string& setting) {
  const auto equals = setting.find('=');
  if (equals == std::string::npos || equals == 0) {
    fail("--set must be key=value, for example matcher.sigma_space=2, but is \"", setting, "\"");
  }
  return {setting.substr(0, equals), setting.substr(equals + 1)};
}

void apply_settings(const std::vector<std::string>& settings, PipelineOptions& options) {
  for (const std::string& setting : settings) {
    const auto [key, value] = split_setting(setting);
    set_option(options, key, value);
  }
}

}  // namespace roadstereo::cli
