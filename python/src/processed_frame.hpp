#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "roadstereo/calibration.hpp"
#include "roadstereo/pipeline.hpp"

namespace roadstereo::python {

/// Maps of results that Python has dropped: the next frames are written into their memory.
class DroppedResults {
 public:
  DroppedResults() { results_.reserve(most); }

  /// The result of an earlier frame, or an empty one.
  FrameResult take() {
    const std::lock_guard lock(mutex_);
    if (results_.empty()) return {};
    FrameResult result = std::move(results_.back());
    results_.pop_back();
    return result;
  }
  void put(FrameResult&& result) {
    const std::lock_guard lock(mutex_);
    if (results_.size() < most) results_.push_back(std::move(result));
  }

 private:
  static constexpr std::size_t most = 2;
  std::mutex mutex_;
  std::vector<FrameResult> results_;
};

/// The result of one pair, with what finding damage in it needs.
class ProcessedFrame {
 public:
  FrameResult result;
  std::optional<StereoCalibration> calibration;
  PipelineOptions options;

  explicit ProcessedFrame(std::shared_ptr<DroppedResults> dropped)
      : result(dropped->take()), dropped_(std::move(dropped)) {}
  ~ProcessedFrame() { dropped_->put(std::move(result)); }
  ProcessedFrame(const ProcessedFrame&) = delete;
  ProcessedFrame& operator=(const ProcessedFrame&) = delete;

 private:
  std::shared_ptr<DroppedResults> dropped_;
};

}  // namespace roadstereo::python
