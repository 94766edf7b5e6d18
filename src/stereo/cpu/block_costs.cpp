#include "stereo/cpu/block_costs.hpp"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "stereo/cpu/block_costs.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for every instruction set
//
#include <hwy/highway.h>

#include "stereo/cpu/vector-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace roadstereo::cpu::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Shorts = hn::Rebind<std::int16_t, Ints>;
using ShortPairs = hn::Repartition<std::int16_t, Ints>;

/// sums + a.first·b.first + a.second·b.second.
HWY_INLINE Int add_pair_products(Int a, Int b, Int sums) {
#if HWY_ARCH_X86 && HWY_TARGET != HWY_SCALAR
  const Ints d;
  Int unused = hn::Zero(d);
  return hn::ReorderWidenMulAccumulate(d, hn::BitCast(ShortPairs(), a), hn::BitCast(ShortPairs(), b), sums, unused);
#else
  const auto first = [](Int pair) { return hn::ShiftRight<16>(hn::ShiftLeft<16>(pair)); };
  const auto second = [](Int pair) { return hn::ShiftRight<16>(pair); };
  return hn::Add(sums, hn::Add(hn::Mul(first(a), first(b)), hn::Mul(second(a), second(b))));
#endif
}

// for i in first … end − 1: sum[i] += e − l; square[i] += e² − l²; pairs[i] = (e, sign·l)
void slide_sums(const std::int16_t* entering, const std::int16_t* leaving, int first, int end, int sign,
                const ColumnSums& sums, SamplePair* pairs) {
  const Ints d;
  const Int low_half = hn::Set(d, 0xFFFF);
  const Int signs = hn::Set(d, sign);
  for (int i = first; i < end; i += static_cast<int>(hn::Lanes(d))) {
    const Int e = hn::PromoteTo(d, hn::LoadU(Shorts(), entering + i));
    const Int l = hn::PromoteTo(d, hn::LoadU(Shorts(), leaving + i));
    hn::StoreU(hn::Add(hn::LoadU(d, sums.sum + i), hn::Sub(e, l)), d, sums.sum + i);
    const Int squares = hn::Sub(hn::Mul(e, e), hn::Mul(l, l));
    hn::StoreU(hn::Add(hn::LoadU(d, sums.square + i), squares), d, sums.square + i);
    hn::StoreU(hn::Or(hn::And(e, low_half), hn::ShiftLeft<16>(hn::Mul(l, signs))), d, pairs + i);
  }
}

// for i in first … end − 1, d < disparities: products[i, d] += own[i]·other[origin − i + d], both of the pair
void slide_products(const SamplePair* own, const SamplePair* other, int origin, int first, int end, int disparities,
                    std::ptrdiff_t pitch, std::int32_t* products) {
  const Ints di;
  const int lanes = static_cast<int>(hn::Lanes(di));
  for (int i = first; i < end; ++i) {
    const Int own_pair = hn::Set(di, own[i]);
    const SamplePair* candidates = other + (origin - i);
    std::int32_t* sums = products + i * pitch;
    for (int d = 0; d < disparities; d += lanes) {
      const Int other_pairs = hn::LoadU(di, candidates + d);
      hn::Store(add_pair_products(own_pair, other_pairs, hn::Load(di, sums + d)), di, sums + d);
    }
  }
}

/// Sums of the 2·radius + 1 columns around i ….
HWY_INLINE Int block_sum(const std::int32_t* column_sums, int i, int radius) {
  const Ints d;
  Int sum = hn::LoadU(d, column_sums + i - radius);
  for (int di = 1 - radius; di <= radius; ++di) sum = hn::Add(sum, hn::LoadU(d, column_sums + i + di));
  return sum;
}

/// 1 / √(σ² + noise²) of blocks with n pixels, 0 where there is no texture, from S = n·mean + e and Q = Σ i²:
/// n·σ² = Q − mean·(S + e) − e² / n, whole numbers up to the last term.
HWY_INLINE Float inverse_deviation(Int sum, Int square, Int mean, Int residue, Float inverse_n, Float noise_variance) {
  const Floats df;
  const Float whole = hn::ConvertTo(df, hn::Sub(square, hn::Mul(mean, hn::Add(sum, residue))));
  const Float e = hn::ConvertTo(df, residue);
  const Float variance = hn::Mul(hn::NegMulAdd(hn::Mul(e, e), inverse_n, whole), inverse_n);
  const Float deviation = hn::Sqrt(hn::Add(hn::Max(variance, hn::Zero(df)), noise_variance));
  const auto textured = hn::Ge(variance, hn::Set(df, min_variance));
  return hn::IfThenElseZero(textured, hn::Div(hn::Set(df, 1.0f), deviation));
}

void block_statistics(const ColumnSums& sums, int block_radius, int pixels, float noise_variance, int first, int end,
                      const BlockStatistics& out) {
  const Ints di;
  const Floats df;
  const Float inverse_n = hn::Set(df, 1.0f / static_cast<float>(pixels));
  const Float noise = hn::Set(df, noise_variance);
  for (int i = first; i < end; i += static_cast<int>(hn::Lanes(di))) {
    const Int sum = block_sum(sums.sum, i, block_radius);
    const Int square = block_sum(sums.square, i, block_radius);
    const Int mean = hn::NearestInt(hn::Mul(hn::ConvertTo(df, sum), inverse_n));
    const Int residue = hn::Sub(sum, hn::Mul(mean, hn::Set(di, pixels)));
    hn::StoreU(sum, di, out.sum + i);
    hn::StoreU(mean, di, out.mean + i);
    hn::StoreU(hn::ConvertTo(df, residue), df, out.residue + i);
    hn::StoreU(inverse_deviation(sum, square, mean, residue, inverse_n, noise), df, out.inverse_deviation + i);
  }
}

/// Where the costs of column i begin.
HWY_INLINE float* costs_of(const CostRow& row, int i, float* cost) {
  return cost + (i - row.block_radius) / row.step * row.pitch;
}

/// The costs of the disparities from first_d on, `vectors` vectors of them, along the columns. `block` slides with the
/// column: Σ over its block of own·other.
template <int vectors, int step>
HWY_INLINE void full_block_costs_of(const CostRow& row, int first_d, int first, int end, float* cost) {
  const Ints di;
  const Floats df;
  const std::size_t lanes = hn::Lanes(di);
  const float inverse_n = 1.0f / static_cast<float>(row.block_rows * (2 * row.block_radius + 1));
  const Float one = hn::Set(df, 1.0f);
  const auto products = [&](int i) { return row.products + i * row.pitch + first_d; };
  Int block[vectors];
  for (int k = 0; k < vectors; ++k) block[k] = hn::Zero(di);
  for (int i = first - row.block_radius; i < first + row.block_radius; ++i) {
    for (std::size_t k = 0; k < vectors; ++k) block[k] = hn::Add(block[k], hn::Load(di, products(i) + k * lanes));
  }
  for (int i = first; i < end; i += step) {
    const std::int32_t* entering = products(i + row.block_radius);
    const std::int32_t* leaving = products(i - row.block_radius);
    const Int own_sum = hn::Set(di, row.own.sum[i]);
    const Float own_mean = hn::Set(df, static_cast<float>(row.own.sum[i]) * inverse_n);
    const Float own_inverse = hn::Set(df, row.own.inverse_deviation[i] * inverse_n);
    const int j = row.origin - i + first_d;
    float* out = cost + (i - row.block_radius) / step * row.pitch + first_d;
    for (std::size_t k = 0; k < vectors; ++k) {
      const std::size_t at = k * lanes;
      const Int sum = hn::Add(block[k], hn::Load(di, entering + at));
      block[k] = hn::Sub(sum, hn::Load(di, leaving + at));
      if constexpr (step == 2) {
        const auto next = static_cast<std::size_t>(row.pitch) + at;
        block[k] = hn::Add(block[k], hn::Sub(hn::Load(di, entering + next), hn::Load(di, leaving + next)));
      }
      const Int whole = hn::Sub(sum, hn::Mul(own_sum, hn::LoadU(di, row.other.mean + j + at)));
      const Float covariance =
          hn::NegMulAdd(own_mean, hn::LoadU(df, row.other.residue + j + at), hn::ConvertTo(df, whole));
      const Float inverse = hn::Mul(own_inverse, hn::LoadU(df, row.other.inverse_deviation + j + at));
      hn::Store(hn::NegMulAdd(covariance, inverse, one), df, out + at);
    }
  }
}

/// The first column at which no disparity below `end_d` clips the block.
HWY_INLINE int first_whole_column(const CostRow& row, int end_d) {
  const int first = std::max(row.first, row.first_visible + end_d - 1 + row.block_radius);
  return first + (first - row.block_radius) % row.step;
}

template <int step>
HWY_INLINE void full_block_costs_with(const CostRow& row, float* cost) {
  const int lanes = static_cast<int>(hn::Lanes(Ints()));
  const int end = std::min(row.end, row.last_valid + 1 - row.block_radius);
  const int first = std::min(end, first_whole_column(row, row.disparities));
  // Near the border every vector of disparities begins where it can.
  for (int d = 0; d < row.disparities; d += lanes) {
    const int begin = first_whole_column(row, std::min(d + lanes, row.disparities));
    if (begin < first) full_block_costs_of<1, step>(row, d, begin, first, cost);
  }
  if (first >= end) return;
  int d = 0;
  for (; d + 3 * lanes < row.disparities; d += 4 * lanes) full_block_costs_of<4, step>(row, d, first, end, cost);
  if (d + lanes < row.disparities) {
    full_block_costs_of<2, step>(row, d, first, end, cost);
    d += 2 * lanes;
  }
  if (d < row.disparities) full_block_costs_of<1, step>(row, d, first, end, cost);
}

void full_block_costs(const CostRow& row, float* cost) {
  if (row.step == 1) {
    full_block_costs_with<1>(row, cost);
  } else {
    full_block_costs_with<2>(row, cost);
  }
}

// For every disparity d whose block is not whole: the block's own columns are max(i − radius, d + first_visible) …
// min(i + radius, last_valid), and the sums over them are differences of running sums.
HWY_INLINE void clipped_block_costs_of(const CostRow& row, const RunningSums& running, int column, float* cost) {
  const Ints di;
  const Floats df;
  const int lanes = static_cast<int>(hn::Lanes(di));
  const int radius = row.block_radius;
  const int last = std::min(column + radius, row.last_valid);
  const Float one = hn::Set(df, 1.0f);
  const Float noise = hn::Set(df, row.noise_variance);
  for (int d = 0; d < row.disparities; d += lanes) {
    if (last == column + radius && column >= first_whole_column(row, std::min(d + lanes, row.disparities))) continue;
    if (d > column - row.first_visible) {
      hn::Store(hn::Zero(df), df, costs_of(row, column, cost) + d);
      continue;
    }
    const Int first_seen = count_from(d + row.first_visible);  // the own column whose counterpart is the first
    const auto clipped = hn::Gt(first_seen, hn::Set(di, column - radius));
    const Int first = hn::IfThenElse(clipped, first_seen, hn::Set(di, column - radius));
    const auto seen = hn::Gt(hn::Set(di, column + 1), first_seen);
    const Int columns = hn::Max(hn::Sub(hn::Set(di, last + 1), first), hn::Set(di, 1));
    const Int n = hn::Mul(columns, hn::Set(di, row.block_rows));
    const Float inverse_n = hn::Div(one, hn::ConvertTo(df, n));

    const auto own_total = [&](const std::int32_t* sums) {
      // Far from the border no lane is clipped, and what is loaded has no meaning.
      const int clipped_from = std::max(d + row.first_visible, -lanes);
      const Int before =
          hn::IfThenElse(clipped, hn::LoadU(di, sums + clipped_from), hn::Set(di, sums[column - radius]));
      return hn::Sub(hn::Set(di, sums[last + 1]), before);
    };
    const auto other_total = [&](const std::int32_t* sums) {
      return hn::Sub(hn::LoadU(di, sums + row.origin - column + d + radius + 1),
                     hn::LoadU(di, sums + row.origin - last + d));
    };
    const auto mean_of = [&](Int sum) { return hn::NearestInt(hn::Mul(hn::ConvertTo(df, sum), inverse_n)); };
    const auto residue_of = [&](Int sum, Int mean) { return hn::Sub(sum, hn::Mul(mean, n)); };

    const Int own_sum = own_total(running.own_sum), other_sum = other_total(running.other_sum);
    const Int own_mean = mean_of(own_sum), other_mean = mean_of(other_sum);
    const Int own_residue = residue_of(own_sum, own_mean), other_residue = residue_of(other_sum, other_mean);
    const Float own_inverse =
        inverse_deviation(own_sum, own_total(running.own_square), own_mean, own_residue, inverse_n, noise);
    const Float other_inverse =
        inverse_deviation(other_sum, other_total(running.other_square), other_mean, other_residue, inverse_n, noise);

    Int product = hn::Zero(di);
    for (int i = column - radius; i <= last; ++i) {
      const auto in_view = hn::Gt(hn::Set(di, i + 1), first_seen);
      product = hn::Add(product, hn::IfThenElseZero(in_view, hn::Load(di, row.products + i * row.pitch + d)));
    }
    const Int whole = hn::Sub(product, hn::Mul(own_sum, other_mean));
    const Float own_exact_mean = hn::Mul(hn::ConvertTo(df, own_sum), inverse_n);
    const Float covariance = hn::NegMulAdd(own_exact_mean, hn::ConvertTo(df, other_residue), hn::ConvertTo(df, whole));
    const Float inverse = hn::Mul(hn::Mul(own_inverse, other_inverse), inverse_n);
    const Float result = hn::NegMulAdd(covariance, inverse, one);
    hn::Store(hn::IfThenElseZero(hn::RebindMask(df, seen), result), df, costs_of(row, column, cost) + d);
  }
}

void clipped_block_costs(const CostRow& row, const RunningSums& running, float* cost) {
  const int whole = first_whole_column(row, row.disparities);
  const int right = std::max(whole, row.last_valid + 1 - row.block_radius);
  for (int i = row.first; i < row.end; i += row.step) {
    if (i >= whole && i < right) continue;
    if (i <= row.last_valid) {
      clipped_block_costs_of(row, running, i, cost);
    } else {
      std::fill_n(costs_of(row, i, cost), row.pitch, 0.0f);
    }
  }
}

}  // namespace roadstereo::cpu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace roadstereo::cpu {

HWY_EXPORT(slide_sums);
HWY_EXPORT(slide_products);
HWY_EXPORT(block_statistics);
HWY_EXPORT(full_block_costs);
HWY_EXPORT(clipped_block_costs);

void slide_sums(const std::int16_t* entering, const std::int16_t* leaving, int first, int end, int sign,
                const ColumnSums& sums, SamplePair* pairs) {
  HWY_DYNAMIC_DISPATCH(slide_sums)(entering, leaving, first, end, sign, sums, pairs);
}

void slide_products(const SamplePair* own, const SamplePair* other, int origin, int first, int end, int disparities,
                    std::ptrdiff_t pitch, std::int32_t* products) {
  HWY_DYNAMIC_DISPATCH(slide_products)(own, other, origin, first, end, disparities, pitch, products);
}

void block_statistics(const ColumnSums& sums, int block_radius, int pixels, float noise_variance, int first, int end,
                      const BlockStatistics& out) {
  HWY_DYNAMIC_DISPATCH(block_statistics)(sums, block_radius, pixels, noise_variance, first, end, out);
}

void full_block_costs(const CostRow& row, float* cost) {
  HWY_DYNAMIC_DISPATCH(full_block_costs)(row, cost);
}

void clipped_block_costs(const CostRow& row, const RunningSums& running, float* cost) {
  HWY_DYNAMIC_DISPATCH(clipped_block_costs)(row, running, cost);
}

}  // namespace roadstereo::cpu
#endif  // HWY_ONCE
