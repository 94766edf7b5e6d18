#pragma once

#include <string>
#include <vector>

#include "roadstereo/device.hpp"
#include "roadstereo/pipeline.hpp"

namespace roadstereo::bench {

struct Size {
  int width, height, disparities;
};

/// The whole pipeline on frames in device memory: medians.
struct PipelineTimes {
  Size size{};
  std::string preset;
  double ms = 0;       ///< on the host's clock, without events in the stream
  double goal_ms = 0;  ///< on an H200; 0: none
  StageTimes stages, floors;
  DeviceProfile profile;  ///< of one frame

  double mde_per_s() const;
};

/// Frames from host memory to host memory.
struct Throughput {
  Size size{};
  int pipelines = 1;
  double per_second = 0, goal = 0;
};

/// libSGM on the same pair.
struct PeerTimes {
  Size size{};
  double ms = 0;

  double mde_per_s() const;
};

struct CudaReport {
  std::string device;
  int runs = 0;
  std::vector<PipelineTimes> pipelines;
  std::vector<Throughput> throughput;
  std::vector<PeerTimes> peers;
};

void print(const PipelineTimes& times);
void print(const Throughput& throughput);
/// Beside the pipeline on frames of that size.
void print(const PeerTimes& peer, const std::vector<PipelineTimes>& pipelines);

/// Throws Error when the file cannot be written.
void write_json(const CudaReport& report, const std::string& path);

}  // namespace roadstereo::bench
