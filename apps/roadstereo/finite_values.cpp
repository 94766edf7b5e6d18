#include "finite_values.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace roadstereo::cli {

std::vector<double> finite_values(ImageView<const float> map) {
  std::vector<double> values;
  values.reserve(map.pixels());
  for (int v = 0; v < map.height(); ++v) {
    std::copy_if(map.row(v), map.row(v) + map.width(), std::back_inserter(values),
                 [](float value) { return std::isfinite(value); });
  }
  return values;
}

double median(std::vector<double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return (*std::max_element(values.begin(), middle) + *middle) / 2;
}

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto rank = std::lround(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + rank, values.end());
  return values[static_cast<std::size_t>(rank)];
}

}  // namespace roadstereo::cli
