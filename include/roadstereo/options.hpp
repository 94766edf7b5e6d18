#pragma once

#include <string>
#include <vector>

#include "roadstereo/pipeline.hpp"

#pragma GCC visibility push(default)
namespace roadstereo {

/// What the value of an option is.
enum class OptionKind { boolean, whole, real, word };

/// One option of the pipeline by its name, as `--set key=value` and result.json spell it.
struct OptionText {
  std::string key;          ///< e.g. "matcher.sigma_space"
  std::string value;        ///< as text
  std::string description;  ///< what it does, unit
  OptionKind kind = OptionKind::word;
};

/// Every option with its present value.
std::vector<OptionText> list_options(const PipelineOptions& options);

/// Sets one option from text. Throws Error for an unknown key (naming the nearest) or a value that does not parse. The
/// range is not checked here, but by `PipelineOptions::validate`.
void set_option(PipelineOptions& options, const std::string& key, const std::string& value);

}  // namespace roadstereo
#pragma GCC visibility pop
