#include <algorithm>
#include <cmath>

#include "graph/track_alignment.hpp"

namespace roadstereo {

std::vector<TimedPosition> frames_to_align(const std::vector<TimedPosition>& frames) {
  constexpr std::size_t most = 500, least_of_piece = 20;
  const std::size_t every = (frames.size() + most - 1) / most;
  std::vector<std::size_t> counts, seen;
  for (const TimedPosition& frame : frames) {
    counts.resize(std::max(counts.size(), frame.piece + 1));
    if (std::isfinite(frame.time_s)) ++counts[frame.piece];
  }
  seen.resize(counts.size());
  std::vector<TimedPosition> taken;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (!std::isfinite(frames[i].time_s)) continue;
    const std::size_t piece = frames[i].piece, number = seen[piece]++;
    const std::size_t every_of_piece = std::max<std::size_t>(1, counts[piece] / least_of_piece);
    if (every <= every_of_piece ? i % every == 0 : number % every_of_piece == 0) taken.push_back(frames[i]);
  }
  return taken;
}

}  // namespace roadstereo
