#include "road/lucas_kanade/window_sums.hpp"

#include <algorithm>
#include <numeric>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "road/lucas_kanade/window_sums.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for every instruction set
//
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace roadstereo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Doubles = hn::CappedTag<double, 8>;
using Double = hn::Vec<Doubles>;

void sum_rows(const float* numbers, std::ptrdiff_t pitch, int rows, int count, double* sums) {
  const Doubles dd;
  const hn::Rebind<float, Doubles> df;
  const int lanes = static_cast<int>(hn::Lanes(dd));
  int i = 0;
  for (; i + lanes <= count; i += lanes) {
    Double sum = hn::Zero(dd);
    for (int y = 0; y < rows; ++y) sum = hn::Add(sum, hn::PromoteTo(dd, hn::LoadU(df, numbers + y * pitch + i)));
    hn::StoreU(sum, dd, sums + i);
  }
  for (; i < count; ++i) {
    sums[i] = 0;
    for (int y = 0; y < rows; ++y) sums[i] += double{numbers[y * pitch + i]};
  }
}

void sum_columns(const double* numbers, int columns, int radius, double* sums) {
  const Doubles dd;
  const int lanes = static_cast<int>(hn::Lanes(dd));
  const auto sum_clipped = [&](int i) {
    sums[i] = std::accumulate(numbers + std::max(0, i - radius), numbers + std::min(columns, i + radius + 1), 0.0);
  };
  int i = 0;
  for (; i < std::min(radius, columns); ++i) sum_clipped(i);
  for (; i + lanes + radius <= columns; i += lanes) {
    Double sum = hn::Zero(dd);
    for (int x = -radius; x <= radius; ++x) sum = hn::Add(sum, hn::LoadU(dd, numbers + i + x));
    hn::StoreU(sum, dd, sums + i);
  }
  for (; i < columns; ++i) sum_clipped(i);
}

}  // namespace roadstereo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace roadstereo {

HWY_EXPORT(sum_rows);
HWY_EXPORT(sum_columns);

void sum_rows(const float* numbers, std::ptrdiff_t pitch, int rows, int count, double* sums) {
  HWY_DYNAMIC_DISPATCH(sum_rows)(numbers, pitch, rows, count, sums);
}

void sum_columns(const double* numbers, int columns, int radius, double* sums) {
  HWY_DYNAMIC_DISPATCH(sum_columns)(numbers, columns, radius, sums);
}

}  // namespace roadstereo
#endif  // HWY_ONCE
