#pragma once

// Included by highway.h, behind the vectors that it computes with.

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>

namespace hwy::HWY_NAMESPACE {

// Arithmetic. Whole numbers wrap around, which only unsigned ones may.

template <class T>
HWY_INLINE Vec1<T> Add(Vec1<T> a, Vec1<T> b) {
  if constexpr (std::is_integral_v<T>) {
    return {static_cast<T>(static_cast<std::uint64_t>(a.raw) + static_cast<std::uint64_t>(b.raw))};
  } else {
    return {a.raw + b.raw};
  }
}
template <class T>
HWY_INLINE Vec1<T> Sub(Vec1<T> a, Vec1<T> b) {
  if constexpr (std::is_integral_v<T>) {
    return {static_cast<T>(static_cast<std::uint64_t>(a.raw) - static_cast<std::uint64_t>(b.raw))};
  } else {
    return {a.raw - b.raw};
  }
}
template <class T>
HWY_INLINE Vec1<T> Mul(Vec1<T> a, Vec1<T> b) {
  if constexpr (std::is_integral_v<T>) {
    return {static_cast<T>(static_cast<std::uint64_t>(a.raw) * static_cast<std::uint64_t>(b.raw))};
  } else {
    return {a.raw * b.raw};
  }
}
template <class T>
HWY_INLINE Vec1<T> Div(Vec1<T> a, Vec1<T> b) {
  return {a.raw / b.raw};
}
template <class T>
HWY_INLINE Vec1<T> Neg(Vec1<T> v) {
  if constexpr (std::is_integral_v<T>) {
    return Sub(Vec1<T>{0}, v);
  } else {
    return {-v.raw};
  }
}
template <class T>
HWY_INLINE Vec1<T> MulAdd(Vec1<T> a, Vec1<T> b, Vec1<T> add) {
  return Add(Mul(a, b), add);
}
template <class T>
HWY_INLINE Vec1<T> MulSub(Vec1<T> a, Vec1<T> b, Vec1<T> sub) {
  return Sub(Mul(a, b), sub);
}
template <class T>
HWY_INLINE Vec1<T> NegMulAdd(Vec1<T> a, Vec1<T> b, Vec1<T> add) {
  return Sub(add, Mul(a, b));
}
HWY_INLINE Vec1<float> Sqrt(Vec1<float> v) {
  return {std::sqrt(v.raw)};
}
HWY_INLINE Vec1<float> Abs(Vec1<float> v) {
  return {std::abs(v.raw)};
}

/// Of a number and NaN, the number.
template <class T>
HWY_INLINE Vec1<T> Min(Vec1<T> a, Vec1<T> b) {
  if constexpr (std::is_floating_point_v<T>) {
    if (std::isnan(a.raw)) return b;
    if (std::isnan(b.raw)) return a;
  }
  return a.raw < b.raw ? a : b;
}
template <class T>
HWY_INLINE Vec1<T> Max(Vec1<T> a, Vec1<T> b) {
  if constexpr (std::is_floating_point_v<T>) {
    if (std::isnan(a.raw)) return b;
    if (std::isnan(b.raw)) return a;
  }
  return a.raw > b.raw ? a : b;
}
template <class T>
HWY_INLINE Vec1<T> Clamp(Vec1<T> v, Vec1<T> low, Vec1<T> high) {
  return Min(Max(low, v), high);
}
template <class D>
HWY_INLINE Vec<D> MinOfLanes(D /*d*/, Vec<D> v) {
  return v;
}

// Comparisons and choices.

template <class T>
HWY_INLINE Mask1<T> Eq(Vec1<T> a, Vec1<T> b) {
  return {a.raw == b.raw};
}
template <class T>
HWY_INLINE Mask1<T> Lt(Vec1<T> a, Vec1<T> b) {
  return {a.raw < b.raw};
}
template <class T>
HWY_INLINE Mask1<T> Gt(Vec1<T> a, Vec1<T> b) {
  return {a.raw > b.raw};
}
template <class T>
HWY_INLINE Mask1<T> Ge(Vec1<T> a, Vec1<T> b) {
  return {a.raw >= b.raw};
}
template <class T>
HWY_INLINE Mask1<T> And(Mask1<T> a, Mask1<T> b) {
  return {a.set && b.set};
}
template <class D, class From>
HWY_INLINE Mask1<TFromD<D>> RebindMask(D /*d*/, Mask1<From> mask) {
  static_assert(sizeof(From) == sizeof(TFromD<D>), "lanes of the same size");
  return {mask.set};
}
template <class T>
HWY_INLINE Vec1<T> IfThenElse(Mask1<T> mask, Vec1<T> yes, Vec1<T> no) {
  return mask.set ? yes : no;
}
template <class T>
HWY_INLINE Vec1<T> IfThenElseZero(Mask1<T> mask, Vec1<T> yes) {
  return mask.set ? yes : Vec1<T>{0};
}
/// The place of the first lane that is set, −1 when none is.
template <class D>
HWY_INLINE std::ptrdiff_t FindFirstTrue(D /*d*/, Mask1<TFromD<D>> mask) {
  return mask.set ? 0 : -1;
}

// Bits of whole numbers.

template <class T>
HWY_INLINE Vec1<T> And(Vec1<T> a, Vec1<T> b) {
  return {static_cast<T>(a.raw & b.raw)};
}
template <class T>
HWY_INLINE Vec1<T> Or(Vec1<T> a, Vec1<T> b) {
  return {static_cast<T>(a.raw | b.raw)};
}
template <int bits, class T>
HWY_INLINE Vec1<T> ShiftLeft(Vec1<T> v) {
  return {static_cast<T>(static_cast<std::make_unsigned_t<T>>(v.raw) << bits)};
}
/// Fills up with the sign.
template <int bits, class T>
HWY_INLINE Vec1<T> ShiftRight(Vec1<T> v) {
  return {static_cast<T>(v.raw >> bits)};
}

// Conversions.

template <class D, class From>
HWY_INLINE Vec<D> BitCast(D /*d*/, Vec1<From> v) {
  return {std::bit_cast<TFromD<D>>(v.raw)};
}
template <class D, class From>
HWY_INLINE Vec<D> PromoteTo(D /*d*/, Vec1<From> v) {
  static_assert(sizeof(TFromD<D>) > sizeof(From), "a wider type");
  return {static_cast<TFromD<D>>(v.raw)};
}
/// The nearest whole number that the narrower type holds.
template <class D, class From>
HWY_INLINE Vec<D> DemoteTo(D /*d*/, Vec1<From> v) {
  using To = TFromD<D>;
  static_assert(std::is_integral_v<From> && sizeof(To) < sizeof(From), "a narrower whole number");
  return {static_cast<To>(std::clamp<From>(v.raw, std::numeric_limits<To>::min(), std::numeric_limits<To>::max()))};
}
/// Whole numbers as floating-point ones.
template <class D, class From>
HWY_INLINE Vec<D> ConvertTo(D /*d*/, Vec1<From> v) {
  static_assert(std::is_integral_v<From> && sizeof(From) == sizeof(TFromD<D>), "whole numbers of the same size");
  return {static_cast<TFromD<D>>(v.raw)};
}
/// Halves go to the even neighbour; what is too large, or NaN, to the end of the range on its sign's side.
HWY_INLINE Vec1<std::int32_t> NearestInt(Vec1<float> v) {
  constexpr float too_large = 2147483648.0f;
  using Range = std::numeric_limits<std::int32_t>;
  if (!(std::abs(v.raw) < too_large)) return {std::signbit(v.raw) ? Range::min() : Range::max()};
  return {static_cast<std::int32_t>(std::lrint(v.raw))};
}

}  // namespace hwy::HWY_NAMESPACE
