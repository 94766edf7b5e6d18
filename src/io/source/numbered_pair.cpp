#include "io/source/numbered_pair.hpp"

#include <algorithm>
#include <string>

namespace roadstereo::io {

SourcePair numbered_pair(std::int64_t index, double rate_hz) {
  constexpr std::size_t digits = 6;
  SourcePair pair;
  pair.index = index;
  pair.name = std::to_string(index);
  pair.name.insert(0, digits - std::min(digits, pair.name.size()), '0');
  if (rate_hz > 0) pair.time_s = static_cast<double>(index) / rate_hz;
  return pair;
}

}  // namespace roadstereo::io
