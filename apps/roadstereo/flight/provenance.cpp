#include "flight/provenance.hpp"

#include <fmt/core.h>

#include <cstdint>
#include <fstream>
#include <iterator>

#include "roadstereo/error.hpp"
#include "roadstereo/options.hpp"
#include "roadstereo/version.hpp"

namespace roadstereo::cli {

namespace {

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

}  // namespace

std::string digest(std::string_view bytes) {
  constexpr std::uint64_t basis = 0xcbf29ce484222325ULL;
  constexpr std::uint64_t prime = 0x100000001b3ULL;
  std::uint64_t hash = basis;
  for (const char byte : bytes) hash = (hash ^ static_cast<unsigned char>(byte)) * prime;
  return fmt::format("{:016x}", hash);
}

std::string content_digest(const std::vector<std::string>& files) {
  std::string bytes;
  for (const std::string& name : files) {
    std::ifstream file(name, std::ios::binary);
    if (!file) fail(name, ": cannot be read");
    bytes.append(std::istreambuf_iterator<char>(file), {});
  }
  return digest(bytes);
}

io::Provenance provenance(const FlightSettings& settings, const PipelineOptions& options) {
  const std::vector<std::string> mask(settings.mask.empty() ? 0 : 1, settings.mask);
  std::vector<std::string> severity_files;
  if (settings.processing.severity != "d6433") severity_files.push_back(settings.processing.severity);
  const std::string& bias = settings.processing.rig_bias;
  io::Provenance entries{{"version", version},
                         {"source", joined(settings.source)},
                         {"calibration", joined(settings.calibration)},
                         {"content of the calibration", content_digest(settings.calibration)},
                         {"--mask", settings.mask},
                         {"content of the mask", content_digest(mask)},
                         {"--no-auto-mask", settings.auto_mask ? "no" : "yes"},
                         {"--severity", settings.processing.severity},
                         {"content of the severities", content_digest(severity_files)},
                         {"--rig-bias", bias},
                         {"content of the rig bias", content_digest(std::vector(bias.empty() ? 0 : 1, bias))},
                         {"--from", std::to_string(settings.from)},
                         {"--every", std::to_string(settings.every)},
                         {"--write", joined(settings.write)},
                         {"--layout", settings.source_settings.layout},
                         {"--topics", joined(settings.source_settings.topics)},
                         {"--max-time-difference", fmt::format("{}", settings.source_settings.max_time_difference_ms)},
                         {"--rate", fmt::format("{}", settings.source_settings.rate_hz)}};
  for (const OptionText& option : list_options(options)) {
    if (option.key != "threads") entries.emplace_back(option.key, option.value);
  }
  return entries;
}

}  // namespace roadstereo::cli
