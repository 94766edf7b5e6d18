#include "road/line_sums.hpp"

#include <algorithm>
#include <array>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "road/line_sums.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for every instruction set
//
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace roadstereo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

void sum_along_lines(const VDisparity& image, float bottom, const float* steps, int count, int row_step, float* sums) {
  const hn::CappedTag<float, 16> df;
  const hn::RebindToSigned<decltype(df)> di;
  const int last = image.rows - 1;
  const auto rounded = hn::Set(df, bottom + 0.5F);
  const auto disparities = hn::Set(di, image.disparities);
  for (int k = 0; k < count; k += static_cast<int>(hn::Lanes(df))) {
    const auto step = hn::LoadU(df, steps + k);
    auto sum = hn::Zero(df);
    for (int r = last; r >= 0; r -= row_step) {
      const auto d = hn::ConvertTo(di, hn::NegMulAdd(step, hn::Set(df, static_cast<float>(last - r)), rounded));
      const auto inside = hn::And(hn::Gt(d, hn::Zero(di)), hn::Lt(d, disparities));
      const auto value = hn::GatherIndex(df, image.row(r), hn::IfThenElseZero(inside, d));
      sum = hn::Add(sum, hn::IfThenElseZero(hn::RebindMask(df, inside), value));
    }
    hn::StoreU(sum, df, sums + k);
  }
}

double sum_along_plane(const DisparityCells& cells, float first, float row_step, float column_step) {
  const hn::CappedTag<float, 16> df;
  const hn::RebindToSigned<decltype(df)> di;
  const int lanes = static_cast<int>(hn::Lanes(df));
  const auto last = hn::Set(df, static_cast<float>(cells.disparities - 1));
  const int row_size = cells.columns * cells.disparities;
  double sum = 0;
  for (int r = 0; r < cells.rows; r += lanes) {  // a row of cells a lane
    const auto row = hn::Iota(df, r);
    const auto of_column = hn::MulAdd(row, hn::Set(df, row_step), hn::Set(df, first));
    const auto of_grid = hn::FirstN(df, static_cast<std::size_t>(cells.rows - r));
    const auto first_value = hn::Mul(hn::ConvertTo(di, row), hn::Set(di, row_size));
    auto sums = hn::Zero(df);
    for (int c = 0; c < cells.columns; ++c) {
      const auto d = hn::MulAdd(hn::Set(df, column_step), hn::Set(df, static_cast<float>(c)), of_column);
      const auto inside = hn::And(of_grid, hn::And(hn::Gt(d, hn::Zero(df)), hn::Lt(d, last)));
      const auto whole = hn::ConvertTo(di, hn::IfThenElseZero(inside, d));
      const auto index = hn::Add(hn::Add(first_value, hn::Set(di, c * cells.disparities)), whole);
      const auto at = hn::IfThenElseZero(hn::RebindMask(di, inside), index);
      const auto before = hn::GatherIndex(df, cells.values, at), after = hn::GatherIndex(df, cells.values + 1, at);
      const auto value = hn::MulAdd(hn::Sub(d, hn::ConvertTo(df, whole)), hn::Sub(after, before), before);
      sums = hn::Add(sums, hn::IfThenElseZero(inside, value));
    }
    std::array<float, 16> of_rows;
    hn::StoreU(sums, df, of_rows.data());
    for (int i = 0; i < std::min(lanes, cells.rows - r); ++i) {
      sum += static_cast<double>(of_rows[static_cast<std::size_t>(i)]);
    }
  }
  return sum;
}

}  // namespace roadstereo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace roadstereo {

HWY_EXPORT(sum_along_lines);
HWY_EXPORT(sum_along_plane);

void sum_along_lines(const VDisparity& image, float bottom, const float* steps, int count, int row_step, float* sums) {
  HWY_DYNAMIC_DISPATCH(sum_along_lines)(image, bottom, steps, count, row_step, sums);
}

double sum_along_plane(const DisparityCells& cells, float first, float row_step, float column_step) {
  return HWY_DYNAMIC_DISPATCH(sum_along_plane)(cells, first, row_step, column_step);
}

}  // namespace roadstereo
#endif  // HWY_ONCE
