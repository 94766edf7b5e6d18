// `roadstereo live` on a synthetic flight out of memory, for tests in a browser and for measurements:
//   live_player WIDTH HEIGHT CALIBRATION live PAIRS [camera] [options of live]
// renders the flight at that size, writes its CALIBRATION, and plays so many pairs at 30 Hz or at --rate. As a `camera`
// it delivers them at that rate and vanishes, again and again.
#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <string>
#include <thread>

#include "calibration_yaml.hpp"
#include "live/live_command.hpp"
#include "tests/live/memory_source.hpp"

namespace roadstereo {
namespace {

/// Delivers the pairs of another source at a rate.
class PacedCamera final : public io::FrameSource {
 public:
  PacedCamera(std::unique_ptr<io::FrameSource> pairs, double interval_s)
      : pairs_(std::move(pairs)), interval_(interval_s) {}

  std::optional<io::SourcePair> next() override {
    std::this_thread::sleep_until(due_ += std::chrono::duration_cast<Clock::duration>(interval_));
    return pairs_->next();
  }
  void skip(std::int64_t pairs) override { pairs_->skip(pairs); }
  std::optional<std::int64_t> size() const override { return std::nullopt; }
  bool live() const override { return true; }
  std::string description() const override { return "camera of " + pairs_->description(); }

 private:
  using Clock = std::chrono::steady_clock;
  std::unique_ptr<io::FrameSource> pairs_;
  std::chrono::duration<double> interval_;
  Clock::time_point due_ = Clock::now();
};

std::unique_ptr<io::FrameSource> open_source(const SharedFrames& frames, const std::vector<std::string>& names,
                                             const io::SourceOptions& options) {
  constexpr double interval_s = 1.0 / 30;
  const bool is_camera = names.size() > 1 && names[1] == "camera";
  MemoryPlan plan;
  plan.pairs = std::stoll(names.at(0));
  plan.interval_s = interval_s;
  if (!is_camera) return std::make_unique<MemorySource>(frames, plan);
  plan.failure = "the camera has vanished";
  const double rate_hz = options.rate_hz > 0 ? options.rate_hz : 1 / interval_s;
  return std::make_unique<PacedCamera>(std::make_unique<MemorySource>(frames, plan), 1 / rate_hz);
}

}  // namespace
}  // namespace roadstereo

int main(int argc, char** argv) {
  using namespace roadstereo;
  if (argc < 6) {
    std::fprintf(stderr, "usage: live_player WIDTH HEIGHT CALIBRATION live PAIRS [camera] [options of live]\n");
    return 2;
  }
  try {
    constexpr int frames = 12;
    const MemoryFlight flight = fly(std::stoi(argv[1]), std::stoi(argv[2]), frames);
    std::ofstream(argv[3]) << cli::plain_yaml(flight.calibration);
    CLI::App app;
    cli::add_live_command(app, [&flight](const std::vector<std::string>& names, const io::SourceOptions& options) {
      return open_source(flight.frames, names, options);
    });
    app.parse(argc - 3, argv + 3);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "live_player: %s\n", error.what());
    return 1;
  }
}
