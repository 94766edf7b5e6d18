#pragma once

#include <cstdint>

// The one instruction set there is, under the names by which Highway lets choose between several. They are ordered as
// Highway's are: the wider the vectors, the smaller the number.
#define HWY_AVX3 (1LL << 8)
#define HWY_SCALAR (1LL << 62)
#define HWY_TARGET HWY_SCALAR
#define HWY_TARGETS HWY_SCALAR

namespace hwy {

inline std::int64_t SupportedTargets() {
  return HWY_TARGETS;
}

/// There is no other to choose.
inline void SetSupportedTargetsForTest(std::int64_t /*targets*/) {}

struct ChosenTarget {
  void Update(std::int64_t /*targets*/) {}
};

inline ChosenTarget GetChosenTarget() {
  return {};
}

inline const char* TargetName(std::int64_t /*target*/) {
  return "one lane, built without Highway";
}

}  // namespace hwy
