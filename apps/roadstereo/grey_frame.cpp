#include "grey_frame.hpp"

#include <algorithm>

namespace roadstereo::cli {

Image<std::uint8_t> grey_of(const Frame& frame) {
  GreyImage sixteenths;
  to_grey(frame.view(), 0, sixteenths);
  Image<std::uint8_t> grey(sixteenths.width(), sixteenths.height());
  for (int v = 0; v < grey.height(); ++v) {
    const std::int16_t* from = sixteenths.row(v);
    std::transform(from, from + grey.width(), grey.row(v),
                   [](std::int16_t value) { return static_cast<std::uint8_t>(value / grey_scale); });
  }
  return grey;
}

}  // namespace roadstereo::cli
