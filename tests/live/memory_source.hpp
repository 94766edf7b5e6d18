#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "roadstereo/error.hpp"
#include "roadstereo/io/frame_source.hpp"
#include "roadstereo/synth.hpp"

namespace roadstereo {

using PairOfFrames = std::pair<Frame, Frame>;
using SharedFrames = std::shared_ptr<const std::vector<PairOfFrames>>;

/// A short flight over the demo road, and its calibration.
struct MemoryFlight {
  SharedFrames frames;
  StereoCalibration calibration;
};

inline MemoryFlight fly(int width, int height, int frames) {
  synth::Scene scene = synth::named_scene("demo");
  const double scale = static_cast<double>(width) / scene.rig.width;
  scene.rig.width = width;
  scene.rig.height = height;
  scene.rig.focal_px *= scale;
  scene.supersampling = 2;
  MemoryFlight flight;
  auto all = std::make_shared<std::vector<PairOfFrames>>();
  for (int i = 0; i < frames; ++i) {
    synth::SyntheticPair pair = synth::render(synth::next_frame(scene, i, 0.04));
    all->emplace_back(std::move(pair.left), std::move(pair.right));
    flight.calibration = pair.calibration;
  }
  flight.frames = all;
  return flight;
}

/// What a source of a test does.
struct MemoryPlan {
  std::int64_t pairs = 0;        ///< it gives; the frames are shown forth and back
  double interval_s = 0;         ///< between their times; 0: it has no times
  bool camera = false;           ///< live
  std::string failure;           ///< thrown after the last pair; empty: it ends
  std::int64_t refused_at = -1;  ///< this pair has a reason instead of frames
};

/// A recording, or a camera, out of memory.
class MemorySource final : public io::FrameSource {
 public:
  MemorySource(SharedFrames frames, MemoryPlan plan) : frames_(std::move(frames)), plan_(std::move(plan)) {}

  std::optional<io::SourcePair> next() override {
    if (place_ >= plan_.pairs) {
      if (!plan_.failure.empty()) throw Error(plan_.failure);
      return std::nullopt;
    }
    io::SourcePair pair;
    pair.index = place_++;
    pair.name = std::to_string(pair.index);
    if (plan_.interval_s > 0) pair.time_s = 1000 + plan_.interval_s * static_cast<double>(pair.index);
    if (pair.index == plan_.refused_at) {
      pair.error = "the file is damaged";
      return pair;
    }
    std::tie(pair.left, pair.right) = (*frames_)[frame_of(pair.index)];
    return pair;
  }

  void skip(std::int64_t pairs) override { place_ = std::min(place_ + pairs, plan_.pairs); }
  std::optional<std::int64_t> size() const override { return plan_.pairs; }
  bool live() const override { return plan_.camera; }
  std::string description() const override { return "memory, " + std::to_string(plan_.pairs) + " pairs"; }

 private:
  std::size_t frame_of(std::int64_t index) const {
    const std::size_t count = frames_->size();
    if (count == 1) return 0;
    const std::size_t place = static_cast<std::size_t>(index) % (2 * count - 2);
    return place < count ? place : 2 * count - 2 - place;
  }

  SharedFrames frames_;
  MemoryPlan plan_;
  std::int64_t place_ = 0;
};

}  // namespace roadstereo
