#include "roadstereo/io/rig_bias_file.hpp"

#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<const char*, RigBias::terms> term_names{"1",   "x",  "y",  "x2",  "xy",   "y2",  "x3", "x2y",
                                                             "xy2", "y3", "x4", "x3y", "x2y2", "xy3", "y4"};

/// A conversion of other numbers could overflow.
int whole_number(const Json& document, const char* key) {
  const double value = document.at(key).get<double>();
  constexpr double largest = std::numeric_limits<int>::max();
  if (!(value >= 0 && value <= largest && value == std::floor(value))) fail(key, " is ", value, "; it must be whole");
  return static_cast<int>(value);
}

RigBias bias_of(const Json& document) {
  RigBias bias;
  bias.width = whole_number(document, "width");
  bias.height = whole_number(document, "height");
  bias.focal_px = document.at("focal_px").is_null() ? 0 : document.at("focal_px").get<double>();
  bias.order = whole_number(document, "order");
  bias.frames = whole_number(document, "frames");
  document.at("region_px").get_to(bias.region_px);
  bias.rms_px = document.at("rms_px").get<double>();
  bias.rms_std_error_px = document.at("rms_stderr_px").get<double>();
  for (std::size_t i = 0; i < RigBias::terms; ++i) {
    const Json& term = document.at("terms").at(term_names[i]);
    bias.value_px[i] = term.at("value_px").get<double>();
    bias.std_error_px[i] = term.at("stderr_px").get<double>();
  }
  return bias;
}

}  // namespace

std::string rig_bias_json(const RigBias& bias) {
  Json terms = Json::object();
  for (std::size_t i = 0; i < RigBias::terms; ++i) {
    terms[term_names[i]] = {{"value_px", bias.value_px[i]}, {"stderr_px", bias.std_error_px[i]}};
  }
  const Json document{{"width", bias.width},
                      {"height", bias.height},
                      {"focal_px", bias.focal_px > 0 ? Json(bias.focal_px) : Json(nullptr)},
                      {"order", bias.order},
                      {"frames", bias.frames},
                      {"region_px", bias.region_px},
                      {"rms_px", bias.rms_px},
                      {"rms_stderr_px", bias.rms_std_error_px},
                      {"terms", terms}};
  constexpr int indent = 2;
  return document.dump(indent) + "\n";
}

RigBias read_rig_bias(const std::string& path) {
  std::ifstream stream(path);
  if (!stream) fail(path, ": cannot be read");
  RigBias bias;
  try {
    bias = bias_of(Json::parse(stream));
    bias.validate();
  } catch (const Json::parse_error&) {
    fail(path, ": this is no rig bias of inspect: it is no JSON, or damaged");
  } catch (const Json::exception& error) {
    const std::string text = error.what();  // "[json.exception.NAME.NUMBER] key 'height' not found"
    fail(path, ": this is no rig bias of inspect: ", text.substr(text.find("] ") + 2));
  } catch (const Error& error) {
    fail(path, ": ", error.what());
  }
  return bias;
}

}  // namespace roadstereo::io
