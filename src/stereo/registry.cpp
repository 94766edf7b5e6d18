#include <cstddef>
#include <deque>
#include <mutex>
#include <optional>
#include <utility>

#include "core/parallel.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/matcher.hpp"
#include "stereo/cpu/cpu_engine.hpp"
#include "stereo/reference/reference_engine.hpp"
#if defined(ROADSTEREO_WITH_CUDA)
#include "core/cuda/device.hpp"
#include "stereo/cuda/cuda_engine.hpp"
#endif

namespace roadstereo {

namespace {

constexpr const char* device_engine = "cuda";

struct Registry {
  std::optional<EngineInfo> device;  ///< stays where it is when `usable` grows
  std::vector<EngineInfo> usable;    ///< best first
  std::vector<UnavailableEngine> absent;
  std::size_t host_engines = 0;  ///< that are among the usable
};

/// Those that need no device, best first.
std::deque<EngineInfo> make_host_engines() {
  std::deque<EngineInfo> engines{
      {"cpu", "threads and SIMD (" + cpu_engine_target() + "), sliding sums, no cost volume", false, make_cpu_engine},
      {"reference", "the paper's equations in double precision: slow, the oracle", true, make_reference_engine}};
#if defined(ROADSTEREO_CUDA_EMULATED)
  engines.push_back({device_engine, "CUDA's kernels emulated on the host: slow, for tests", false, make_cuda_engine});
#endif
  return engines;
}

/// Engines of the host, including those of register_engine. Adding one keeps references to the others valid.
std::deque<EngineInfo>& host_engines() {
  static std::deque<EngineInfo> of_this_machine = make_host_engines();
  return of_this_machine;
}

Registry find_device_engine() {
  Registry registry;
#if defined(ROADSTEREO_WITH_CUDA) && !defined(ROADSTEREO_CUDA_EMULATED)
  if (const cuda::Device device = cuda::find_device(); device.usable) {
    registry.device = EngineInfo{device_engine, "CUDA on " + device.name, false, make_cuda_engine};
    registry.usable.push_back(*registry.device);
  } else {
    registry.absent.push_back({device_engine, device.reason});
  }
#elif !defined(ROADSTEREO_WITH_CUDA)
  registry.absent.push_back({device_engine, "this build was made without CUDA (CMake option ROADSTEREO_CUDA)"});
#endif
  return registry;
}

/// Looks for a device, which makes a CUDA context of some hundred megabytes: only where one may be used.
const Registry& registry() {
  static Registry of_this_machine = find_device_engine();
  static std::mutex mutex;  // pipelines of several threads may be the first
  const std::lock_guard lock(mutex);
  Registry& all = of_this_machine;
  for (; all.host_engines < host_engines().size(); ++all.host_engines) {
    all.usable.push_back(host_engines()[all.host_engines]);
  }
  return all;
}

}  // namespace

const std::vector<EngineInfo>& engines() {
  return registry().usable;
}

void register_engine(EngineInfo engine) {
  const auto fail_name = [&](const char* reason) { fail("the engine '", engine.name, "' cannot be added: ", reason); };
  if (engine.name.empty() || engine.name == "auto") fail_name("it needs a name other than auto");
  if (!engine.make) fail_name("it has no function that makes it");
  if (engine.name == device_engine) fail_name("the library has one of that name");
  for (const EngineInfo& known : host_engines()) {
    if (known.name == engine.name) fail_name("there is one of that name");
  }
  host_engines().push_back(std::move(engine));
}

const std::vector<UnavailableEngine>& unavailable_engines() {
  return registry().absent;
}

const EngineInfo& find_engine(const std::string& name) {
  for (const EngineInfo& info : host_engines()) {
    if (info.name == name) return info;
  }
  const Registry& all = registry();
  if (all.device && (name == "auto" || name == all.device->name)) return *all.device;
  if (name == "auto") return host_engines().front();
  std::string known = "auto";
  for (const EngineInfo& info : all.usable) known += ", " + info.name;
  for (const UnavailableEngine& absent : unavailable_engines()) {
    if (absent.name == name) fail("the engine ", name, " cannot be used: ", absent.reason, "; there are: ", known);
  }
  fail("there is no engine called '", name, "'; this build has: ", known);
}

std::string resolve_engine_name(const std::string& name) {
  return find_engine(name).name;
}

std::unique_ptr<StereoEngine> make_engine(const std::string& name, int threads) {
  return find_engine(name).make(resolve_threads(threads));
}

}  // namespace roadstereo
