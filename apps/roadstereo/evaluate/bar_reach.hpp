#pragma once

#include "roadstereo/io/plot.hpp"

namespace roadstereo::cli {

/// Height at which bars of methods are cut off: that of the largest of every series but BM, which would squeeze the
/// others, with room above.
double reach_without_bm(const io::BarGroups& bars);

}  // namespace roadstereo::cli
