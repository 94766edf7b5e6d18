#include "map/run_folder.hpp"

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "flight/flight_trajectory.hpp"
#include "mask_file.hpp"
#include "processing_options.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/io/rig_bias_file.hpp"
#include "roadstereo/io/severity_file.hpp"
#include "roadstereo/options.hpp"
#include "source_options.hpp"

namespace roadstereo::cli {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

/// An input whose path is relative to the folder; what is no file there is as given.
std::string input_path(const fs::path& folder, const std::string& name) {
  std::error_code absent;
  const fs::path path = (folder / name).lexically_normal();
  return fs::exists(path, absent) ? path.string() : name;
}

/// An input that is a file, whose path is relative to the folder.
std::string input_file(const fs::path& folder, const std::string& name) {
  std::error_code absent;
  const fs::path path = (folder / name).lexically_normal();
  if (fs::exists(path, absent)) return path.string();
  fail(folder.string(), ": the run was made with ", path.string(),
       ", which does not exist; keep the run and its recording at the places that they had during inspect");
}

std::vector<std::string> input_paths(const fs::path& folder, const Json& names) {
  std::vector<std::string> paths;
  for (const Json& name : names) paths.push_back(input_path(folder, name.get<std::string>()));
  return paths;
}

PipelineOptions options_of(const Json& options) {
  PipelineOptions result;
  for (const auto& [key, value] : options.items()) {
    if (key != "threads") set_option(result, key, value.is_string() ? value.get<std::string>() : value.dump());
  }
  result.validate();
  return result;
}

MapPass pass_of(const fs::path& folder, const Json& summary) {
  const Json& inputs = summary.at("inputs");
  MapPass pass;
  pass.source = input_paths(folder, inputs.at("source"));
  for (const Json& name : inputs.at("calibration")) {
    pass.calibration.push_back(input_file(folder, name.get<std::string>()));
  }
  SourceSettings& source = pass.source_settings;
  source.layout = inputs.at("layout").get<std::string>();
  source.topics = inputs.at("topics").get<std::vector<std::string>>();
  source.max_time_difference_ms = inputs.at("max_time_difference_ms").get<double>();
  source.rate_hz = inputs.at("rate_hz").get<double>();
  pass.from = summary.at("from").get<std::int64_t>();
  if (const Json& to = summary.at("to"); !to.is_null()) pass.to = to.get<std::int64_t>();
  pass.every = summary.at("every").get<std::int64_t>();
  if (const Json& crs = summary.at("crs"); !crs.is_null()) pass.crs = crs.get<std::string>();
  pass.time_offset_s = inputs.at("track_offset_s").get<double>();
  const std::string mask = inputs.at("mask").get<std::string>();
  if (!mask.empty()) pass.mask = read_mask(input_file(folder, mask), 255);
  pass.options = options_of(summary.at("options"));
  const std::string severity = inputs.value("severity", ProcessingSettings().severity);
  const bool is_file = severity != ProcessingSettings().severity;
  pass.options.damage.severity = io::read_severity_scheme(is_file ? input_file(folder, severity) : severity);
  const std::string bias = inputs.at("rig_bias").get<std::string>();
  if (!bias.empty()) pass.options.rig_bias = io::read_rig_bias(input_file(folder, bias));
  pass.find_white_level = inputs.value("finds_white_level", pass.options.white_level == 0);
  if (pass.find_white_level) pass.options.white_level = 0;
  return pass;
}

}  // namespace

MapPass read_run(const fs::path& folder) {
  const fs::path file = folder / "summary.json";
  std::ifstream stream(file);
  if (!stream) fail(folder.string(), ": this run is not finished; continue it with inspect --resume");
  MapPass pass;
  try {
    const Json summary = Json::parse(stream);
    if (!summary.at("run").at("complete").get<bool>()) {
      fail(folder.string(), ": this run is not finished; continue it with inspect --resume");
    }
    pass = pass_of(fs::canonical(folder), summary);
  } catch (const Json::exception&) {
    fail(file.string(), ": this is not the summary of a run of this version, or it is damaged");
  }
  pass.trajectory = (folder / trajectory_file_names().front()).string();
  std::error_code absent;
  if (!fs::exists(pass.trajectory, absent)) {
    fail(folder.string(),
         " contains an output of inspect (summary.json), but this run has no trajectory; add it with "
         "inspect --trajectory --resume");
  }
  return pass;
}

}  // namespace roadstereo::cli
