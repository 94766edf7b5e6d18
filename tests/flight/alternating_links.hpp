#pragma once

#include <vector>

#include "roadstereo/odometry.hpp"

namespace roadstereo::test {

/// Number of links in alternating_links.
constexpr int link_count = 20;

/// Links of every frame with the next one, of which `value` is in turn `mean` + `noise` and `mean` − `noise`. The mean
/// of all of them has the standard error `noise` / √(link_count − 1).
inline std::vector<FrameLink> alternating_links(double FrameLink::*value, double FrameLink::*sd, double mean,
                                                double noise) {
  std::vector<FrameLink> links;
  for (int i = 0; i < link_count; ++i) {
    FrameLink& link = links.emplace_back();
    link.from = i;
    link.to = i + 1;
    link.*value = mean + (i % 2 == 0 ? noise : -noise);
    link.*sd = 0.1;
  }
  return links;
}

}  // namespace roadstereo::test
