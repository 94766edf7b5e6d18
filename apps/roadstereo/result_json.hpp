#pragma once

#include <string>

#include "inspection.hpp"

namespace roadstereo::cli {

/// The content of result.json. What is not known is null.
std::string result_json(const Inspection& inspection);

}  // namespace roadstereo::cli
