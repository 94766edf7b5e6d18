#pragma once

// What the kernels use of Highway, for builds without it: vectors of one lane, as of Highway's own HWY_SCALAR target,
// with its names and its results. tests/test_one_lane.cpp holds both to the same expectations.

#include <hwy/targets.h>

#include <cstddef>
#include <cstdint>
#include <type_traits>

#if defined(__x86_64__) || defined(__i386__)
#define HWY_ARCH_X86 1
#else
#define HWY_ARCH_X86 0
#endif
#if defined(__aarch64__)
#define HWY_ARCH_ARM_A64 1
#else
#define HWY_ARCH_ARM_A64 0
#endif

#define HWY_INLINE inline __attribute__((always_inline))
#define HWY_NAMESPACE N_ONE_LANE
#define HWY_ONCE 1
#define HWY_BEFORE_NAMESPACE() static_assert(true, "takes the semicolon")
#define HWY_AFTER_NAMESPACE() static_assert(true, "takes the semicolon")
#define HWY_EXPORT(function) static_assert(true, "takes the semicolon")
#define HWY_DYNAMIC_DISPATCH(function) HWY_NAMESPACE::function

namespace hwy::HWY_NAMESPACE {

/// Says which lanes a vector has.
template <class Lane>
struct Tag {
  using T = Lane;
};

template <class D>
using TFromD = typename D::T;
template <class T>
using ScalableTag = Tag<T>;
template <class T, std::size_t max_lanes>
using CappedTag = Tag<T>;
template <class T, class D>
using Rebind = Tag<T>;
template <class T, class D>
using Repartition = Tag<T>;
template <class D>
using RebindToSigned = Tag<std::conditional_t<sizeof(TFromD<D>) == sizeof(std::int32_t), std::int32_t, void>>;

template <class T>
struct Vec1 {
  T raw;
};
template <class T>
struct Mask1 {
  bool set;
};
template <class D>
using Vec = Vec1<TFromD<D>>;

template <class D>
constexpr std::size_t Lanes(D /*d*/) {
  return 1;
}

// Values and memory.

template <class D>
HWY_INLINE Vec<D> Zero(D /*d*/) {
  return {0};
}
template <class D, class T>
HWY_INLINE Vec<D> Set(D /*d*/, T value) {
  return {static_cast<TFromD<D>>(value)};
}
/// first, first + 1, … of which there is the first.
template <class D, class T>
HWY_INLINE Vec<D> Iota(D d, T first) {
  return Set(d, first);
}
template <class D>
HWY_INLINE Vec<D> LoadU(D /*d*/, const TFromD<D>* from) {
  return {*from};
}
template <class D>
HWY_INLINE Vec<D> Load(D d, const TFromD<D>* aligned) {
  return LoadU(d, aligned);
}
template <class D>
HWY_INLINE void StoreU(Vec<D> v, D /*d*/, TFromD<D>* to) {
  *to = v.raw;
}
template <class D>
HWY_INLINE void Store(Vec<D> v, D d, TFromD<D>* aligned) {
  StoreU(v, d, aligned);
}
template <class T>
HWY_INLINE T GetLane(Vec1<T> v) {
  return v.raw;
}

}  // namespace hwy::HWY_NAMESPACE

#include <hwy/operations.h>
