#pragma once

#include <array>
#include <cstddef>

#include "core/cuda/event.hpp"
#include "core/cuda/stream.hpp"
#include "roadstereo/pipeline.hpp"

namespace roadstereo::cuda {

/// Device events at the end of each stage of a frame: a clock on the host sees only when stages were enqueued.
class StageClock {
 public:
  enum Mark {
    begin,
    converted,
    road_known,
    transformed_target,
    searched,
    matched,
    refined,
    fitted,
    transformed,
    marks
  };

  void mark(Mark at, StreamView stream) { events_[at].record(stream.get()); }

  /// Fills all times but `total`, which the host measures. The device must have passed every mark.
  void read(StageTimes& ms) const {
    ms.prepare = between(begin, converted);
    ms.road_model = between(converted, road_known);
    ms.perspective = between(road_known, transformed_target);
    ms.coarse = between(transformed_target, searched);
    ms.match = between(searched, matched);
    ms.refinement = between(matched, refined);
    ms.roll = between(refined, fitted);
    ms.transform = between(fitted, transformed);
  }

 private:
  double between(Mark from, Mark to) const { return events_[to].ms_since(events_[from]); }

  std::array<Event, marks> events_;
};

}  // namespace roadstereo::cuda
