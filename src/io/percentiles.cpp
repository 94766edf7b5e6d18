#include <algorithm>
#include <cmath>

#include "core/order_statistics.hpp"
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
    found.push_back(nearest_quantile(values, share / 100));
  }
  return found;
}

}  // namespace roadstereo::io
