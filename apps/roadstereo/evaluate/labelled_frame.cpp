#include "evaluate/labelled_frame.hpp"

#include <algorithm>
#include <cmath>

namespace roadstereo::cli {

int disparities_of(ImageView<const float> truth, int usual) {
  double max_disparity = 0;
  for (int v = 0; v < truth.height(); ++v) {
    for (int u = 0; u < truth.width(); ++u) max_disparity = std::fmax(max_disparity, truth(u, v));
  }
  return std::max(usual, static_cast<int>(std::ceil(max_disparity)) + 1);
}

}  // namespace roadstereo::cli
