#pragma once

#include "live/clock.hpp"
#include "roadstereo/io/frame_source.hpp"

namespace roadstereo::cli {

/// A pair on its way from the source.
struct CapturedPair {
  io::SourcePair pair;
  Clock::time_point arrival{};
  double clock_s = 0;  ///< the same by the calendar, seconds since 1970
};

}  // namespace roadstereo::cli
