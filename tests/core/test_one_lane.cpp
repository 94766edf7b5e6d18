// Vectors of one lane, as the build without Highway has them. Where Highway is there, its own scalar target is held to
// the same expectations.

#include <gtest/gtest.h>
#include <hwy/highway.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

namespace roadstereo {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Floats = hn::ScalableTag<float>;
using Ints = hn::ScalableTag<std::int32_t>;
using Shorts = hn::Rebind<std::int16_t, Ints>;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr std::int32_t lowest = std::numeric_limits<std::int32_t>::min();
constexpr std::int32_t highest = std::numeric_limits<std::int32_t>::max();

auto f(float value) {
  return hn::Set(Floats(), value);
}
auto i(std::int32_t value) {
  return hn::Set(Ints(), value);
}
template <class V>
auto lane(V v) {
  return hn::GetLane(v);
}
template <class M>
bool is_set(M mask) {
  return lane(hn::IfThenElse(mask, f(1), f(0))) == 1;
}

TEST(OneLane, HasOneLane) {
  static_assert(HWY_TARGET == HWY_SCALAR);
  EXPECT_EQ(hn::Lanes(hn::CappedTag<float, 16>()), 1U);
  EXPECT_EQ(lane(hn::Iota(Floats(), 3)), 3);
  EXPECT_EQ(lane(hn::Zero(Ints())), 0);
  EXPECT_EQ(lane(hn::MinOfLanes(Floats(), f(-2))), -2);
}

TEST(OneLane, LoadsAndStoresOneValue) {
  alignas(16) const float from[] = {1, 2, 3, 4};
  alignas(16) float to[] = {0, 0, 0, 0};
  hn::StoreU(hn::LoadU(Floats(), from + 1), Floats(), to + 1);
  hn::Store(hn::Load(Floats(), from), Floats(), to);
  EXPECT_EQ(to[0], 1);
  EXPECT_EQ(to[1], 2);
  EXPECT_EQ(to[2], 0);
}

TEST(OneLane, FloatingPointArithmetic) {
  EXPECT_EQ(lane(hn::Add(f(16777216), f(1))), 16777216) << "rounded to single precision";
  EXPECT_EQ(lane(hn::Sub(f(1), f(3))), -2);
  EXPECT_EQ(lane(hn::Mul(f(4097), f(4097))), 16785408) << "rounded to single precision";
  EXPECT_EQ(lane(hn::Div(f(1), f(3))), 1.0f / 3);
  EXPECT_EQ(lane(hn::Sqrt(f(2))), std::numbers::sqrt2_v<float>);
  EXPECT_EQ(lane(hn::MulAdd(f(3), f(5), f(7))), 22);
  EXPECT_EQ(lane(hn::MulSub(f(3), f(5), f(7))), 8);
  EXPECT_EQ(lane(hn::NegMulAdd(f(3), f(5), f(7))), -8);
  EXPECT_EQ(lane(hn::Abs(f(-2))), 2);
  EXPECT_FALSE(std::signbit(lane(hn::Abs(f(-0.0f)))));
  EXPECT_TRUE(std::signbit(lane(hn::Neg(f(0)))));
}

TEST(OneLane, IntegersWrapAround) {
  EXPECT_EQ(lane(hn::Add(i(highest), i(1))), lowest);
  EXPECT_EQ(lane(hn::Sub(i(lowest), i(1))), highest);
  EXPECT_EQ(lane(hn::Mul(i(-65537), i(65537))), -131073);
  EXPECT_EQ(lane(hn::Mul(i(65536), i(-65536))), 0);
  EXPECT_EQ(lane(hn::Neg(i(lowest))), lowest);
  EXPECT_EQ(lane(hn::Neg(i(5))), -5);
}

TEST(OneLane, MinimumAndMaximum) {
  EXPECT_EQ(lane(hn::Min(i(-3), i(2))), -3);
  EXPECT_EQ(lane(hn::Max(i(-3), i(2))), 2);
  EXPECT_EQ(lane(hn::Min(f(-infinity), f(2))), -infinity);
  EXPECT_EQ(lane(hn::Min(f(nan), f(2))), 2);
  EXPECT_EQ(lane(hn::Min(f(2), f(nan))), 2);
  EXPECT_EQ(lane(hn::Max(f(nan), f(2))), 2);
  EXPECT_EQ(lane(hn::Max(f(2), f(nan))), 2);
  EXPECT_EQ(lane(hn::Clamp(f(7), f(-1), f(1))), 1);
  EXPECT_EQ(lane(hn::Clamp(f(-7), f(-1), f(1))), -1);
  EXPECT_EQ(lane(hn::Clamp(f(0.5f), f(-1), f(1))), 0.5f);
}

TEST(OneLane, ComparisonAndSelection) {
  EXPECT_TRUE(is_set(hn::Lt(f(1), f(2))));
  EXPECT_FALSE(is_set(hn::Lt(f(2), f(2))));
  EXPECT_TRUE(is_set(hn::Ge(f(2), f(2))));
  EXPECT_FALSE(is_set(hn::Ge(f(nan), f(2))));
  EXPECT_FALSE(is_set(hn::Gt(f(2), f(2))));
  EXPECT_FALSE(is_set(hn::Eq(f(nan), f(nan))));
  EXPECT_TRUE(is_set(hn::Eq(f(-0.0f), f(0))));
  EXPECT_TRUE(is_set(hn::RebindMask(Floats(), hn::Gt(i(3), i(-3)))));
  EXPECT_TRUE(is_set(hn::And(hn::Lt(f(1), f(2)), hn::Gt(f(2), f(1)))));
  EXPECT_FALSE(is_set(hn::And(hn::Lt(f(1), f(2)), hn::Gt(f(1), f(2)))));
  EXPECT_EQ(lane(hn::IfThenElse(hn::Gt(i(1), i(2)), i(10), i(20))), 20);
  EXPECT_EQ(lane(hn::IfThenElseZero(hn::Gt(f(3), f(2)), f(10))), 10);
  EXPECT_EQ(lane(hn::IfThenElseZero(hn::Gt(f(1), f(2)), f(nan))), 0);
  EXPECT_EQ(hn::FindFirstTrue(Floats(), hn::Eq(f(1), f(1))), 0);
  EXPECT_LT(hn::FindFirstTrue(Floats(), hn::Eq(f(1), f(2))), 0);
}

TEST(OneLane, Shifts) {
  EXPECT_EQ(lane(hn::And(i(0x0FF0), i(-256))), 0x0F00);
  EXPECT_EQ(lane(hn::Or(i(0x0F), i(0x30))), 0x3F);
  EXPECT_EQ(lane(hn::ShiftLeft<16>(i(0x18001))), lowest + 0x10000);
  EXPECT_EQ(lane(hn::ShiftRight<16>(i(-1 - 65536))), -2);
  EXPECT_EQ(lane(hn::ShiftRight<4>(i(255))), 15);
  EXPECT_EQ(lane(hn::BitCast(Ints(), f(1))), 0x3F800000);
  EXPECT_EQ(lane(hn::BitCast(Floats(), i(0x40490FDB))), std::numbers::pi_v<float>);
}

TEST(OneLane, Conversions) {
  const auto short_of = [](std::int32_t value) { return lane(hn::DemoteTo(Shorts(), i(value))); };
  EXPECT_EQ(short_of(-7), -7);
  EXPECT_EQ(short_of(40000), 32767);
  EXPECT_EQ(short_of(-40000), -32768);
  EXPECT_EQ(lane(hn::PromoteTo(Ints(), hn::Set(Shorts(), std::int16_t{-300}))), -300);
  EXPECT_EQ(lane(hn::ConvertTo(Floats(), i(-16777217))), -16777216);
}

TEST(OneLane, RoundsHalvesToEven) {
  const auto nearest = [](float value) { return lane(hn::NearestInt(f(value))); };
  EXPECT_EQ(nearest(0.5f), 0);
  EXPECT_EQ(nearest(1.5f), 2);
  EXPECT_EQ(nearest(-0.5f), 0);
  EXPECT_EQ(nearest(-1.5f), -2);
  EXPECT_EQ(nearest(-2.5f), -2);
  EXPECT_EQ(nearest(2.49f), 2);
  EXPECT_EQ(nearest(std::nextafter(0.5f, 0.0f)), 0);
  EXPECT_EQ(nearest(8388609), 8388609);
  EXPECT_EQ(nearest(-3e9f), lowest);
  EXPECT_EQ(nearest(3e9f), highest);
}

}  // namespace
}  // namespace roadstereo
