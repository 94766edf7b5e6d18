#pragma once

#include "live/clock.hpp"
#include "roadstereo/io/frame_source.hpp"

namespace roadstereo::cli {

/// A pair with its time of arrival.
struct CapturedPair {
  io::SourcePair pair;
  Clock::time_point arrival{};
  double clock_s = 0;  ///< the same as system time, seconds since 1970
};

}  // namespace roadstereo::cli
