#pragma once

#include <cstdint>

#include "roadstereo/image.hpp"
#include "roadstereo/pixel_box.hpp"

namespace roadstereo {

/// Call `visit(v, first, last)` for the runs of pixels of a damage: columns `first` … `last` of row v, row by row.
template <class Visit>
void for_each_run(const Image<std::uint16_t>& ids, int id, const PixelBox& box, const Visit& visit) {
  for (int v = box.v0; v <= box.v1; ++v) {
    const std::uint16_t* const row = ids.row(v);
    for (int u = box.u0; u <= box.u1; ++u) {
      if (row[u] != id) continue;
      const int first = u;
      while (u < box.u1 && row[u + 1] == id) ++u;
      visit(v, first, u);
    }
  }
}

}  // namespace roadstereo
