#pragma once

#include <string>

#include "roadstereo/rig_bias.hpp"

#pragma GCC visibility push(default)
namespace roadstereo::io {

/// Returns the text of a file of the field, JSON. Numbers are read back bit for bit.
std::string rig_bias_json(const RigBias& bias);

/// Reads such a file. Throws Error naming the file and the value.
RigBias read_rig_bias(const std::string& path);

}  // namespace roadstereo::io
#pragma GCC visibility pop
