#pragma once

namespace roadstereo::cli {

/// Lowers the priority of the calling thread.
void lower_priority();

}  // namespace roadstereo::cli
