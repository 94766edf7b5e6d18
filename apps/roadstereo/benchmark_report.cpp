#include "benchmark_report.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/order_statistics.hpp"
#include "json_text.hpp"
#include "roadstereo/version.hpp"

namespace roadstereo::cli {
namespace {

constexpr double bytes_per_mb = 1 << 20;

nlohmann::ordered_json timing_json(const Timing& timing) {
  return {{"name", timing.name},
          {"median_ms", timing.median()},
          {"min_ms", timing.fastest()},
          {"max_ms", timing.slowest()},
          {"runs", timing.ms.size()}};
}

std::string timing_line(const Timing& timing) {
  return fmt::format("  {:<14} {:>9.2f} {:>9.2f} {:>9.2f}", timing.name, timing.median(), timing.fastest(),
                     timing.slowest());
}

std::string device_text(const DeviceProfile& device) {
  std::string text = fmt::format("\n  {:<20} {:>8} {:>9} {:>7} {:>7} {:>9} {:>9} {:>9} {:>9}\n", "kernel", "launches",
                                 "ms", "blocks", "threads", "occupancy", "registers", "local B", "shared B");
  for (const KernelProfile& kernel : device.kernels) {
    text += fmt::format("  {:<20} {:>8} {:>9.4f} {:>7} {:>7} {:>9.2f} {:>9} {:>9} {:>9}\n", kernel.name,
                        kernel.launches, kernel.ms, kernel.blocks, kernel.threads, kernel.occupancy, kernel.registers,
                        kernel.local_bytes, kernel.shared_bytes);
  }
  return text + fmt::format("  {} launches, {} waits, {} bytes up, {} bytes down\n", device.launches, device.waits,
                            device.bytes_up, device.bytes_down);
}

nlohmann::ordered_json device_json(const DeviceProfile& device) {
  nlohmann::ordered_json document = {{"launches", device.launches},
                                     {"waits", device.waits},
                                     {"bytes_up", device.bytes_up},
                                     {"bytes_down", device.bytes_down},
                                     {"kernels", nlohmann::ordered_json::array()}};
  for (const KernelProfile& kernel : device.kernels) {
    document["kernels"].push_back({{"name", kernel.name},
                                   {"launches", kernel.launches},
                                   {"ms", kernel.ms},
                                   {"blocks", kernel.blocks},
                                   {"threads", kernel.threads},
                                   {"occupancy", kernel.occupancy},
                                   {"registers", kernel.registers},
                                   {"local_bytes", kernel.local_bytes},
                                   {"shared_bytes", kernel.shared_bytes}});
  }
  return document;
}

}  // namespace

double Timing::median() const {
  return ms.empty() ? 0 : upper_median(std::vector(ms));
}
double Timing::fastest() const {
  return ms.empty() ? 0 : *std::min_element(ms.begin(), ms.end());
}
double Timing::slowest() const {
  return ms.empty() ? 0 : *std::max_element(ms.begin(), ms.end());
}

double BenchmarkReport::mde_per_s() const {
  return static_cast<double>(width) * height * disparities * 1e-6 / (total.median() * 1e-3);
}

std::string cpu_name() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    const auto colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

std::string report_text(const BenchmarkReport& report) {
  std::string text =
      fmt::format("{}×{}, D {}, preset {}, engine {} ({}), {} threads, {}\n\n", report.width, report.height,
                  report.disparities, report.preset, report.engine, report.target, report.threads, report.cpu);
  text += fmt::format("  {:<14} {:>9} {:>9} {:>9}\n", "milliseconds", "median", "min", "max");
  for (const Timing& stage : report.stages) text += timing_line(stage) + "\n";
  text += timing_line(report.total) + fmt::format("   {:.0f} Mde/s\n", report.mde_per_s());
  text += timing_line(report.first) + "   road model estimated\n";
  if (!report.baselines.empty()) {
    const std::string heading =
        report.raw_disparities > 0 ? fmt::format("OpenCV, D {}", report.raw_disparities) : "OpenCV";
    text += fmt::format("\n  {:<14} {:>9} {:>9} {:>9}   total / OpenCV\n", heading, "median", "min", "max");
  }
  for (const Timing& peer : report.baselines) {
    text += timing_line(peer) + fmt::format("   {:.2f}\n", report.total.median() / peer.median());
  }
  if (report.device) text += device_text(*report.device);
  text += "\n";
  if (report.allocations) text += fmt::format("  allocations per frame: {:.0f}\n", *report.allocations);
  if (report.scratch_bytes) {
    text += fmt::format("  memory of the pipeline, its images and maps included: {:.1f} MB\n",
                        static_cast<double>(*report.scratch_bytes) / bytes_per_mb);
  }
  text += fmt::format("  peak memory of the process: {:.0f} MB\n",
                      static_cast<double>(report.peak_memory_bytes) / bytes_per_mb);
  return text;
}

std::string report_json(const BenchmarkReport& report) {
  nlohmann::ordered_json document = {{"version", version},
                                     {"width", report.width},
                                     {"height", report.height},
                                     {"disparities", report.disparities},
                                     {"preset", report.preset},
                                     {"engine", report.engine},
                                     {"simd_target", report.target},
                                     {"threads", report.threads},
                                     {"cpu", report.cpu}};
  for (const Timing& stage : report.stages) document["stages"].push_back(timing_json(stage));
  document["total"] = timing_json(report.total);
  document["first_frame"] = timing_json(report.first);
  document["mde_per_s"] = report.mde_per_s();
  if (report.raw_disparities > 0) document["raw_disparities"] = report.raw_disparities;
  document["peers"] = nlohmann::ordered_json::array();
  for (const Timing& peer : report.baselines) {
    nlohmann::ordered_json entry = timing_json(peer);
    entry["ratio"] = report.total.median() / peer.median();
    document["peers"].push_back(entry);
  }
  if (report.device) document["device"] = device_json(*report.device);
  document["allocations_per_frame"] =
      report.allocations ? nlohmann::ordered_json(*report.allocations) : nlohmann::ordered_json();
  document["pipeline_memory_bytes"] =
      report.scratch_bytes ? nlohmann::ordered_json(*report.scratch_bytes) : nlohmann::ordered_json();
  document["peak_memory_bytes"] = report.peak_memory_bytes;
  return json_text(document);
}

}  // namespace roadstereo::cli
