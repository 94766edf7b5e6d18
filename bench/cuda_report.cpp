#include "cuda_report.hpp"

#include <cstdio>
#include <fstream>
#include <ostream>
#include <utility>

#include "roadstereo/error.hpp"

namespace roadstereo::bench {
namespace {

using Stage = std::pair<const char*, double StageTimes::*>;
constexpr Stage stage_names[] = {{"prepare", &StageTimes::prepare},
                                 {"road model", &StageTimes::road_model},
                                 {"perspective", &StageTimes::perspective},
                                 {"coarse", &StageTimes::coarse},
                                 {"match", &StageTimes::match},
                                 {"refinement", &StageTimes::refinement},
                                 {"road geometry", &StageTimes::roll},
                                 {"transform", &StageTimes::transform}};

double evaluations_per_second(const Size& size, double ms) {
  return 1e-6 * size.width * size.height * size.disparities / (ms * 1e-3);
}

const char* verdict(bool reached) {
  return reached ? "reached" : "MISSED";
}

void write_size(std::ostream& out, const Size& size) {
  out << "\"width\": " << size.width << ", \"height\": " << size.height << ", \"disparities\": " << size.disparities;
}

void write_profile(std::ostream& out, const DeviceProfile& profile) {
  out << "\"launches\": " << profile.launches << ", \"waits\": " << profile.waits
      << ", \"bytes_up\": " << profile.bytes_up << ", \"bytes_down\": " << profile.bytes_down << ", \"kernels\": [";
  const char* separator = "";
  for (const KernelProfile& kernel : profile.kernels) {
    out << separator << "\n      {\"name\": \"" << kernel.name << "\", \"launches\": " << kernel.launches
        << ", \"ms\": " << kernel.ms << ", \"blocks\": " << kernel.blocks << ", \"threads\": " << kernel.threads
        << ", \"occupancy\": " << kernel.occupancy << ", \"registers\": " << kernel.registers
        << ", \"local_bytes\": " << kernel.local_bytes << ", \"shared_bytes\": " << kernel.shared_bytes << "}";
    separator = ",";
  }
  out << "]";
}

void write_pipeline(std::ostream& out, const PipelineTimes& times) {
  out << "    {";
  write_size(out, times.size);
  out << ", \"preset\": \"" << times.preset << "\", \"ms\": " << times.ms << ", \"goal_ms\": " << times.goal_ms
      << ", \"mde_per_s\": " << times.mde_per_s() << ",\n     \"stages\": {";
  const char* separator = "";
  for (const auto& [name, member] : stage_names) {
    out << separator << "\"" << name << "\": {\"ms\": " << times.stages.*member
        << ", \"floor_ms\": " << times.floors.*member << "}";
    separator = ", ";
  }
  out << "},\n     ";
  write_profile(out, times.profile);
  out << "}";
}

template <class Values, class Write>
void write_list(std::ostream& out, const char* name, const Values& values, Write write) {
  out << "  \"" << name << "\": [";
  const char* separator = "\n";
  for (const auto& value : values) {
    out << separator;
    write(value);
    separator = ",\n";
  }
  out << "]";
}

}  // namespace

double PipelineTimes::mde_per_s() const {
  return evaluations_per_second(size, ms);
}
double PeerTimes::mde_per_s() const {
  return evaluations_per_second(size, ms);
}

/// The floor of matching is that of the whole range: where search ranges leave much out, its ratio may be below 1.
void print(const PipelineTimes& times) {
  std::printf("%dx%d, D %d, %s: %.3f ms, %.0f Mde/s", times.size.width, times.size.height, times.size.disparities,
              times.preset.c_str(), times.ms, times.mde_per_s());
  if (times.goal_ms > 0)
    std::printf("; goal %.2f ms: %s (%.2f)", times.goal_ms, verdict(times.ms <= times.goal_ms),
                times.ms / times.goal_ms);
  std::printf("\n");
  for (const auto& [name, member] : stage_names) {
    const double ms = times.stages.*member, floor = times.floors.*member;
    std::printf("  %-18s %8.4f ms", name, ms);
    if (floor > 0) std::printf("   floor %8.4f ms, ratio %5.1f", floor, ms / floor);
    std::printf("\n");
  }
  std::printf("  %-20s %8s %9s %7s %7s %9s %9s %7s %8s\n", "kernel", "launches", "ms", "blocks", "threads", "occupancy",
              "registers", "local B", "shared B");
  for (const KernelProfile& kernel : times.profile.kernels) {
    std::printf("  %-20s %8d %9.4f %7d %7d %9.2f %9d %7d %8d\n", kernel.name.c_str(), kernel.launches, kernel.ms,
                kernel.blocks, kernel.threads, kernel.occupancy, kernel.registers, kernel.local_bytes,
                kernel.shared_bytes);
  }
  std::printf("  %d launches, %d waits, %zu bytes up, %zu bytes down\n", times.profile.launches, times.profile.waits,
              times.profile.bytes_up, times.profile.bytes_down);
}

void print(const Throughput& throughput) {
  std::printf("%dx%d host to host, %d pipeline%s: %7.0f frames/s", throughput.size.width, throughput.size.height,
              throughput.pipelines, throughput.pipelines == 1 ? " " : "s", throughput.per_second);
  if (throughput.goal > 0)
    std::printf("  goal %.0f: %s", throughput.goal, verdict(throughput.per_second >= throughput.goal));
  std::printf("\n");
}

void print(const PeerTimes& peer, const std::vector<PipelineTimes>& pipelines) {
  std::printf("%dx%d, D %d, libSGM: %.3f ms, %.0f Mde/s\n", peer.size.width, peer.size.height, peer.size.disparities,
              peer.ms, peer.mde_per_s());
  constexpr double goal = 2;
  for (const PipelineTimes& own : pipelines) {
    if (own.size.width != peer.size.width || own.size.disparities != peer.size.disparities) continue;
    const double ratio = own.mde_per_s() / peer.mde_per_s();
    std::printf("  %-18s %8.2f times the Mde/s; goal %.0f: %s\n", own.preset.c_str(), ratio, goal,
                verdict(ratio >= goal));
  }
}

void write_json(const CudaReport& report, const std::string& path) {
  std::ofstream out(path);
  if (!out) fail("cannot write ", path);
  out << "{\n  \"device\": \"" << report.device << "\", \"runs\": " << report.runs << ",\n";
  write_list(out, "pipelines", report.pipelines, [&](const PipelineTimes& times) { write_pipeline(out, times); });
  out << ",\n";
  write_list(out, "throughput", report.throughput, [&](const Throughput& of) {
    out << "    {";
    write_size(out, of.size);
    out << ", \"pipelines\": " << of.pipelines << ", \"frames_per_s\": " << of.per_second << ", \"goal\": " << of.goal
        << "}";
  });
  out << ",\n";
  write_list(out, "libsgm", report.peers, [&](const PeerTimes& peer) {
    out << "    {";
    write_size(out, peer.size);
    out << ", \"ms\": " << peer.ms << ", \"mde_per_s\": " << peer.mde_per_s() << "}";
  });
  out << "\n}\n";
  out.close();
  if (!out) fail<SystemError>("cannot write ", path, ": the disk may be full");
}

}  // namespace roadstereo::bench
