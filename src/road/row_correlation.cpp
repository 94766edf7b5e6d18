#include "road/row_correlation.hpp"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "road/row_correlation.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for every instruction set
//
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace roadstereo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, row_guard>;
using Float = hn::Vec<Floats>;
using Integers = hn::RebindToSigned<Floats>;
using Integer = hn::Vec<Integers>;

void add_products(const std::int16_t* left, const std::int16_t* right, const RowCorrelations& row, int sign,
                  std::int32_t* sums) {
  const hn::RebindToSigned<Floats> d32;
  const hn::Rebind<std::int16_t, Floats> d16;
  const int lanes = static_cast<int>(hn::Lanes(d32));
  for (int u = 0; u < row.width; u += lanes) {
    const auto grey = hn::PromoteTo(d32, hn::LoadU(d16, left + u));
    const auto signed_grey = sign < 0 ? hn::Neg(grey) : grey;
    for (int d = 0; d < row.disparities; ++d) {
      std::int32_t* sum = sums + d * row.pitch + u;
      const auto other = hn::PromoteTo(d32, hn::LoadU(d16, right + u - d));
      hn::StoreU(hn::Add(hn::LoadU(d32, sum), hn::Mul(signed_grey, other)), d32, sum);
    }
  }
}

HWY_INLINE void keep_better(Float correlation, Float disparity, const BestOfRow& best, std::ptrdiff_t at) {
  const Floats df;
  const Float before = hn::LoadU(df, best.correlation + at);
  const auto better = hn::Gt(correlation, before);
  hn::StoreU(hn::IfThenElse(better, correlation, before), df, best.correlation + at);
  hn::StoreU(hn::IfThenElse(better, disparity, hn::LoadU(df, best.disparity + at)), df, best.disparity + at);
}

/// The sums of a block's columns.
HWY_INLINE Integer block_sum(const std::int32_t* centre) {
  const Integers d32;
  auto sum = hn::LoadU(d32, centre);
  for (int x = 1; x <= row_block_half_width; ++x) {
    sum = hn::Add(sum, hn::Add(hn::LoadU(d32, centre - x), hn::LoadU(d32, centre + x)));
  }
  return sum;
}

/// n times the covariance of blocks of n pixels: (Σ own·other − sum_own·mean_other) − sum_own·residue_other, the
/// bracket in whole numbers.
HWY_INLINE Float block_covariance(Integer products, Integer own_sum, Integer other_mean, Float other_residue) {
  const Floats df;
  const Float whole = hn::ConvertTo(df, hn::Sub(products, hn::Mul(own_sum, other_mean)));
  return hn::NegMulAdd(hn::ConvertTo(df, own_sum), other_residue, whole);
}

void correlate_row(const std::int32_t* sums, const BlockRow& left, const BlockRow& right, const RowCorrelations& row,
                   const BestOfRow& best_of_left, const BestOfRow& best_of_right) {
  const Floats df;
  const Integers d32;
  const int lanes = static_cast<int>(hn::Lanes(df));
  const Float per_pixel = hn::Set(df, 1.0f / row_block_pixels), none = hn::Set(df, -1.0f);
  for (int d = 0; d < row.disparities; ++d) {
    const Float disparity = hn::Set(df, static_cast<float>(d));
    for (int u = 0; u < row.width; u += lanes) {
      const std::ptrdiff_t at = d * row.pitch + u, there = std::ptrdiff_t{u} - d;
      const Float inverse =
          hn::Mul(hn::LoadU(df, left.inverse_deviation + u), hn::LoadU(df, right.inverse_deviation + there));
      const Float covariance = hn::Mul(
          per_pixel, block_covariance(block_sum(sums + at), hn::LoadU(d32, left.sum + u),
                                      hn::LoadU(d32, right.mean + there), hn::LoadU(df, right.residue + there)));
      const Float correlation = hn::IfThenElse(hn::Gt(inverse, hn::Zero(df)), hn::Mul(covariance, inverse), none);
      hn::StoreU(correlation, df, row.values + at);
      keep_better(correlation, disparity, best_of_left, u);
      keep_better(correlation, disparity, best_of_right, there);
    }
  }
}

void find_rivals(const RowCorrelations& row, const float* best_disparity, float* rivals) {
  const Floats df;
  const int lanes = static_cast<int>(hn::Lanes(df));
  const Float near = hn::Set(df, 2.0f), none = hn::Set(df, -1.0f);
  for (int u = 0; u < row.width; u += lanes) {
    const Float best = hn::LoadU(df, best_disparity + u);
    Float rival = none;
    for (int d = 0; d < row.disparities; ++d) {
      const Float away = hn::Abs(hn::Sub(best, hn::Set(df, static_cast<float>(d))));
      const Float value = hn::LoadU(df, row.values + std::ptrdiff_t{d} * row.pitch + u);
      rival = hn::Max(rival, hn::IfThenElse(hn::Gt(away, near), value, none));
    }
    hn::StoreU(rival, df, rivals + u);
  }
}

/// (1 − ρ²)^−6 of a correlation; 0 of a block without a counterpart.
HWY_INLINE Float likelihood(Float correlation) {
  const Floats df;
  const Float one = hn::Set(df, 1.0f);
  const Float rho = hn::Min(hn::Max(correlation, hn::Zero(df)), hn::Set(df, 0.98f));
  const Float unexplained = hn::NegMulAdd(rho, rho, one);
  const Float inverse = hn::Div(one, unexplained);
  const Float cubed = hn::Mul(inverse, hn::Mul(inverse, inverse));
  return hn::IfThenElseZero(hn::Gt(correlation, hn::Set(df, -1.0f)), hn::Mul(cubed, cubed));
}

void add_evidence(const RowCorrelations& row, int first, float* posterior, const EvidenceCell& cell) {
  const Floats df;
  const int lanes = static_cast<int>(hn::Lanes(df));
  const Float zero = hn::Zero(df), one = hn::Set(df, 1.0f), half = hn::Set(df, 0.5f), quarter = hn::Set(df, 0.25f);
  const Float smallest_chance = hn::Set(df, 0.05f);
  for (int u = first; u < first + evidence_columns && u < row.width; u += lanes) {
    const auto inside = hn::Lt(hn::Iota(df, static_cast<float>(u)), hn::Set(df, static_cast<float>(row.width)));
    Float total = zero, count = zero;
    for (int d = 0; d < row.disparities; ++d) {
      const Float p =
          hn::IfThenElseZero(inside, likelihood(hn::LoadU(df, row.values + std::ptrdiff_t{d} * row.pitch + u)));
      hn::StoreU(p, df, posterior + std::ptrdiff_t{d} * lanes);
      total = hn::Add(total, p);
      count = hn::Add(count, hn::IfThenElseZero(hn::Gt(p, zero), one));
    }
    const auto seen = hn::Gt(count, zero);
    const Float inverse_total = hn::IfThenElseZero(seen, hn::Div(one, total));
    const Float inverse_count = hn::IfThenElseZero(seen, hn::Div(one, count));
    const Float per_chance = hn::Mul(count, inverse_total);  // posterior over prior of a likelihood of 1
    Float before = zero, at = hn::LoadU(df, posterior), cumulative = zero, chance = zero;
    for (int d = 0; d < row.disparities; ++d) {
      const Float after = d + 1 < row.disparities ? hn::LoadU(df, posterior + std::ptrdiff_t{d + 1} * lanes) : zero;
      const auto valid = hn::Gt(at, zero);
      const Float smooth = hn::MulAdd(at, half, hn::Mul(hn::Add(before, after), quarter));
      const Float ratio = hn::Mul(smooth, per_chance);
      const Float support = hn::Div(hn::Mul(hn::Set(df, 3.2f), hn::Sub(ratio, one)), hn::Add(ratio, hn::Set(df, 6.0f)));
      cumulative = hn::MulAdd(at, inverse_total, cumulative);
      chance = hn::Add(chance, hn::IfThenElseZero(valid, inverse_count));
      cell.support[d] += hn::GetLane(hn::SumOfLanes(df, hn::IfThenElseZero(valid, support)));
      const Float excess = hn::Max(zero, hn::Sub(cumulative, chance));
      const Float missing = hn::Div(excess, hn::Max(hn::Sub(one, chance), smallest_chance));
      cell.beyond[d] += hn::GetLane(hn::SumOfLanes(df, hn::Mul(missing, missing)));
      before = at;
      at = after;
    }
  }
}

}  // namespace roadstereo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace roadstereo {

HWY_EXPORT(add_products);
HWY_EXPORT(correlate_row);
HWY_EXPORT(find_rivals);
HWY_EXPORT(add_evidence);

void add_products(const std::int16_t* left, const std::int16_t* right, const RowCorrelations& row, int sign,
                  std::int32_t* sums) {
  HWY_DYNAMIC_DISPATCH(add_products)(left, right, row, sign, sums);
}

void correlate_row(const std::int32_t* sums, const BlockRow& left, const BlockRow& right, const RowCorrelations& row,
                   const BestOfRow& best_of_left, const BestOfRow& best_of_right) {
  HWY_DYNAMIC_DISPATCH(correlate_row)(sums, left, right, row, best_of_left, best_of_right);
}

void find_rivals(const RowCorrelations& row, const float* best_disparity, float* rivals) {
  HWY_DYNAMIC_DISPATCH(find_rivals)(row, best_disparity, rivals);
}

void add_evidence(const RowCorrelations& row, int first, float* posterior, const EvidenceCell& cell) {
  HWY_DYNAMIC_DISPATCH(add_evidence)(row, first, posterior, cell);
}

}  // namespace roadstereo
#endif  // HWY_ONCE
