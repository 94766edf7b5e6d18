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

std::vector<EngineInfo> make_registry() {
  std::vector<EngineInfo> registry{
      {"cpu", "threads and SIMD (" + cpu_engine_target() + "), sliding sums, no cost volume", false, make_cpu_engine},
      {"reference", "the paper's equations in double precision: slow, the oracle", true, make_reference_engine},
  };
#if defined(ROADSTEREO_CUDA_EMULATED)
  registry.push_back({"cuda", "CUDA's kernels emulated on the host: slow, for tests", false, make_cuda_engine});
#elif defined(ROADSTEREO_WITH_CUDA)
  if (const cuda::Device device = cuda::find_device(); device.usable) {
    registry.insert(registry.begin(), {"cuda", "CUDA on " + device.name, false, make_cuda_engine});
  }
#endif
  return registry;
}

}  // namespace

const std::vector<EngineInfo>& engines() {
  static const std::vector<EngineInfo> registry = make_registry();
  return registry;
}

namespace {

const EngineInfo& find_engine(const std::string& name) {
  if (name == "auto") return engines().front();
  std::string known = "auto";
  for (const EngineInfo& info : engines()) {
    if (info.name == name) return info;
    known += ", " + info.name;
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
