#include "evaluate/bar_reach.hpp"

#include <cmath>
#include <limits>

namespace roadstereo::cli {

double reach_without_bm(const io::BarGroups& bars) {
  constexpr double room = 1.1;
  double largest = std::numeric_limits<double>::min();
  for (std::size_t i = 0; i < bars.series.size(); ++i) {
    if (bars.series[i] == "BM") continue;
    for (const double value : bars.values[i]) largest = std::fmax(largest, room * value);
  }
  return largest;
}

}  // namespace roadstereo::cli
