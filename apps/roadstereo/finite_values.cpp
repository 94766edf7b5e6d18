#include "finite_values.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>

#include "core/order_statistics.hpp"

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
  return central_median(values);
}

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  return nearest_quantile(values, share);
}

double rms(const std::vector<double>& values) {
  const double squares = std::inner_product(values.begin(), values.end(), values.begin(), 0.0);
  return std::sqrt(squares / static_cast<double>(values.size()));
}

}  // namespace roadstereo::cli
