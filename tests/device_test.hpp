#pragma once

#include <gtest/gtest.h>

#include "core/cuda/device.hpp"

namespace roadstereo::test {

/// A test that is skipped, with the reason, where no GPU can run it.
class OnDevice : public testing::Test {
 protected:
  void SetUp() override {
    const cuda::Device device = cuda::find_device();
    if (!device.usable) GTEST_SKIP() << device.reason;
  }
};

}  // namespace roadstereo::test
