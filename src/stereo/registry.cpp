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

struct Registry {
  std::vector<EngineInfo> usable;  ///< best first
  std::vector<UnavailableEngine> absent;
};

Registry make_registry() {
  Registry registry;
#if defined(ROADSTEREO_WITH_CUDA) && !defined(ROADSTEREO_CUDA_EMULATED)
  if (const cuda::Device device = cuda::find_device(); device.usable) {
    registry.usable.push_back({"cuda", "CUDA on " + device.name, false, make_cuda_engine});
  } else {
    registry.absent.push_back({"cuda", device.reason});
  }
#elif !defined(ROADSTEREO_WITH_CUDA)
  registry.absent.push_back({"cuda", "this build was made without CUDA (CMake option ROADSTEREO_CUDA)"});
#endif
  registry.usable.push_back(
      {"cpu", "threads and SIMD (" + cpu_engine_target() + "), sliding sums, no cost volume", false, make_cpu_engine});
  registry.usable.push_back(
      {"reference", "the paper's equations in double precision: slow, the oracle", true, make_reference_engine});
#if defined(ROADSTEREO_CUDA_EMULATED)
  registry.usable.push_back({"cuda", "CUDA's kernels emulated on the host: slow, for tests", false, make_cuda_engine});
#endif
  return registry;
}

Registry& registry() {
  static Registry of_this_machine = make_registry();
  return of_this_machine;
}

}  // namespace

const std::vector<EngineInfo>& engines() {
  return registry().usable;
}

void register_engine(EngineInfo engine) {
  const auto fail_name = [&](const char* reason) { fail("the engine '", engine.name, "' cannot be added: ", reason); };
  if (engine.name.empty() || engine.name == "auto") fail_name("it needs a name other than auto");
  if (!engine.make) fail_name("it has no function that makes it");
  for (const EngineInfo& known : engines()) {
    if (known.name == engine.name) fail_name("there is one of that name");
  }
  for (const UnavailableEngine& known : unavailable_engines()) {
    if (known.name == engine.name) fail_name("the library has one of that name, which this machine cannot run");
  }
  registry().usable.push_back(std::move(engine));
}

const std::vector<UnavailableEngine>& unavailable_engines() {
  return registry().absent;
}

namespace {

const EngineInfo& find_engine(const std::string& name) {
  if (name == "auto") return engines().front();
  std::string known = "auto";
  for (const EngineInfo& info : engines()) {
    if (info.name == name) return info;
    known += ", " + info.name;
  }
  for (const UnavailableEngine& absent : unavailable_engines()) {
    if (absent.name == name) fail("the engine ", name, " cannot be used: ", absent.reason, "; there are: ", known);
  }
  fail("there is no engine called '", name, "'; this build has: ", known);
}

}  // namespace

std::string resolve_engine_name(const std::string& name) {
  return find_engine(name).name;
}

std::unique_ptr<StereoEngine> make_engine(const std::string& name, int threads) {
  return find_engine(name).make(resolve_threads(threads));
}

}  // namespace roadstereo
