#include "flight/link_mean.hpp"

#include <cmath>
#include <cstddef>
#include <map>

namespace roadstereo::cli {

std::optional<LinkMean> mean_of_links(const std::vector<LinkValue>& links) {
  constexpr std::size_t min_references = 10;
  double weights = 0, sum = 0;
  for (const LinkValue& link : links) {
    const double weight = 1 / (link.sd * link.sd);
    weights += weight;
    sum += weight * link.value;
  }
  std::map<int, double> scores;
  const double mean = sum / weights;
  for (const LinkValue& link : links) scores[link.reference] += (link.value - mean) / (link.sd * link.sd);
  if (scores.size() < min_references) return std::nullopt;
  double squares = 0;
  for (const auto& [reference, score] : scores) squares += score * score;
  const auto count = static_cast<double>(scores.size());
  return LinkMean{mean, std::sqrt(squares * count / (count - 1)) / weights};
}

}  // namespace roadstereo::cli
