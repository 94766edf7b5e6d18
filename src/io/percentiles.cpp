#include <algorithm>
#include <cmath>

#include "io/panels.hpp"

namespace roadstereo::io {

std::vector<double> percentiles(ImageView<const float> map, std::initializer_list<double> shares) {
  std::vector<float> values;
  values.reserve(map.pixels());
  for (int v = 0; v < map.height(); ++v) {
    std::copy_if(map.row(v), map.row(v) + map.width(), std::back_inserter(values),
                 [](float value) { return std::isfinite(value); });
  }
  std::vector<double> found;
  if (values.empty()) return found;
  for (const double share : shares) {
    const auto rank = static_cast<std::ptrdiff_t>(std::lround(share / 100 * static_cast<double>(values.size() - 1)));
    std::nth_element(values.begin(), values.begin() + rank, values.end());
    found.push_back(values[static_cast<std::size_t>(rank)]);
  }
  return found;
}

}  // namespace roadstereo::io
