#pragma once

namespace roadstereo::cli {

/// The calling thread gives way to the others when cores are short.
void lower_priority();

}  // namespace roadstereo::cli
