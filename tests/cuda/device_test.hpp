#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <optional>

#include "core/cuda/device.hpp"

namespace roadstereo::test {

/// A test that is skipped, with the reason, where no GPU can run it; it fails where ROADSTEREO_NEEDS_GPU is set in the
/// environment.
class OnDevice : public testing::Test {
 protected:
  void SetUp() override {
    const cuda::Device device = cuda::find_device();
    if (device.usable) return;
    if (std::getenv("ROADSTEREO_NEEDS_GPU") != nullptr) FAIL() << device.reason;
    GTEST_SKIP() << device.reason;
  }
};

/// Whether kernels are compiled by the host's compiler. Else a value at the edge of a threshold may be rounded to its
/// other side: what is compared then is bounded, not equal.
#if defined(ROADSTEREO_CUDA_EMULATED)
inline constexpr bool kernels_round_as_host = true;
#else
inline constexpr bool kernels_round_as_host = false;
#endif

/// A stage that takes device memory as soon as it is made: it is made by its first use, which a skipped test has not.
template <class Stage>
class MadeOnUse {
 public:
  Stage& operator*() {
    if (!stage_) stage_.emplace();
    return *stage_;
  }
  Stage* operator->() { return &**this; }

 private:
  std::optional<Stage> stage_;
};

}  // namespace roadstereo::test
