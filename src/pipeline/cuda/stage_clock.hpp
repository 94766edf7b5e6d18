#pragma once

#include <array>
#include <cstddef>

#include "core/cuda/memory.hpp"
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

  void mark(Mark at, cudaStream_t stream) { ROADSTEREO_CUDA(cudaEventRecord(events_[at].get(), stream)); }

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
  double between(Mark from, Mark to) const {
    float ms = 0;
    ROADSTEREO_CUDA(cudaEventElapsedTime(&ms, events_[from].get(), events_[to].get()));
    return static_cast<double>(ms);
  }

  class Event {
   public:
    Event() { ROADSTEREO_CUDA(cudaEventCreate(&event_)); }
    ~Event() { static_cast<void>(cudaEventDestroy(event_)); }
    Event(const Event&) = delete;
    Event& operator=(const Event&) = delete;
    cudaEvent_t get() const { return event_; }

   private:
    cudaEvent_t event_ = nullptr;
  };

  std::array<Event, marks> events_;
};

}  // namespace roadstereo::cuda
