#include "stereo/cpu/rows.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "stereo/cpu/rows.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for every instruction set
//
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace roadstereo::cpu::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::ScalableTag<float>;
using Ints = hn::ScalableTag<std::int32_t>;
using Shorts = hn::Rebind<std::int16_t, Ints>;
using Float = hn::Vec<Floats>;
using Int = hn::Vec<Ints>;

HWY_INLINE Int load_widened(const std::int16_t* from) {
  return hn::PromoteTo(Ints(), hn::LoadU(Shorts(), from));
}

void slide_products(const std::int16_t* entering_ref, const std::int16_t* entering_tar, const std::int16_t* leaving_ref,
                    const std::int16_t* leaving_tar, int width, std::int32_t* sums) {
  const Ints d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  for (int u = 0; u < width; u += lanes) {
    const Int entering = hn::Mul(load_widened(entering_ref + u), load_widened(entering_tar + u));
    const Int leaving = hn::Mul(load_widened(leaving_ref + u), load_widened(leaving_tar + u));
    hn::StoreU(hn::Add(hn::LoadU(d, sums + u), hn::Sub(entering, leaving)), d, sums + u);
  }
}

/// Sums of the 2·radius + 1 columns around u ….
HWY_INLINE Int block_sum(const std::int32_t* column_sums, int u, int radius) {
  const Ints d;
  Int sum = hn::LoadU(d, column_sums + u - radius);
  for (int du = 1 - radius; du <= radius; ++du) sum = hn::Add(sum, hn::LoadU(d, column_sums + u + du));
  return sum;
}

void block_statistics(const std::int32_t* column_sums, const std::int32_t* column_squares, int block_radius,
                      int pixels_in_block, float noise_variance, int width, const BlockStatisticsRow& out) {
  const Ints di;
  const Floats df;
  const int lanes = static_cast<int>(hn::Lanes(di));
  const Float n = hn::Set(df, static_cast<float>(pixels_in_block));
  const Float inverse_n = hn::Set(df, 1.0f / static_cast<float>(pixels_in_block));
  for (int u = 0; u < width; u += lanes) {
    const Int sum = block_sum(column_sums, u, block_radius);
    const Int mean = hn::NearestInt(hn::Mul(hn::ConvertTo(df, sum), inverse_n));
    const Int residue = hn::Sub(sum, hn::Mul(mean, hn::Set(di, pixels_in_block)));
    // n·σ² = Σ i² − m·S − m·e − e² / n with S = n·m + e: whole numbers up to the last term.
    const Int squares = hn::Sub(block_sum(column_squares, u, block_radius), hn::Mul(mean, hn::Add(sum, residue)));
    const Float e = hn::ConvertTo(df, residue);
    const Float variance = hn::Mul(hn::NegMulAdd(hn::Mul(e, e), inverse_n, hn::ConvertTo(df, squares)), inverse_n);
    const Float deviation = hn::Sqrt(hn::Add(hn::Max(variance, hn::Zero(df)), hn::Set(df, noise_variance)));
    const auto textured = hn::Ge(variance, hn::Set(df, smallest_variance));
    const Float inverse = hn::IfThenElseZero(textured, hn::Div(hn::Set(df, 1.0f), hn::Mul(n, deviation)));
    hn::StoreU(sum, di, out.sum + u);
    hn::StoreU(mean, di, out.mean + u);
    hn::StoreU(residue, di, out.residue + u);
    hn::StoreU(inverse, df, out.inverse_deviation + u);
  }
}

void correlation_row(const std::int32_t* column_sums, const BlockStatistics& ref, const BlockStatistics& tar,
                     int block_radius, int pixels_in_block, int first, int last, float* cost) {
  const Ints di;
  const Floats df;
  const int lanes = static_cast<int>(hn::Lanes(di));
  const Float one = hn::Set(df, 1.0f);
  const Float n = hn::Set(df, static_cast<float>(pixels_in_block));
  const Float inverse_n = hn::Set(df, 1.0f / static_cast<float>(pixels_in_block));
  for (int u = first; u <= last; u += lanes) {
    const Int products = block_sum(column_sums, u, block_radius);
    const Int residue_ref = hn::LoadU(di, ref.residue + u);
    const Int residue_tar = hn::LoadU(di, tar.residue + u);
    const Int covariance = hn::Sub(hn::Sub(products, hn::Mul(hn::LoadU(di, ref.mean + u), residue_tar)),
                                   hn::Mul(hn::LoadU(di, tar.mean + u), hn::LoadU(di, ref.sum + u)));
    const Float rest = hn::Mul(hn::Mul(hn::ConvertTo(df, residue_ref), hn::ConvertTo(df, residue_tar)), inverse_n);
    const Float scaled = hn::Mul(hn::Sub(hn::ConvertTo(df, covariance), rest), n);
    const Float deviations =
        hn::Mul(hn::LoadU(df, ref.inverse_deviation + u), hn::LoadU(df, tar.inverse_deviation + u));
    const Float result = hn::NegMulAdd(scaled, deviations, one);
    if (u + lanes - 1 <= last) {
      hn::StoreU(result, df, cost + u);
    } else {
      HWY_ALIGN float tail[HWY_MAX_BYTES / sizeof(float)];
      hn::Store(result, df, tail);
      std::copy_n(tail, last - u + 1, cost + u);
    }
  }
}

/// 2^x for x ≤ 0, relative error below 3e-6; x below −100 gives a vanishing number.
HWY_INLINE Float power_of_two(Float x) {
  const Floats df;
  const Ints di;
  const Float bounded = hn::Max(x, hn::Set(df, -100.0f));
  const Int whole = hn::NearestInt(bounded);
  const Float f = hn::Sub(bounded, hn::ConvertTo(df, whole));
  Float p = hn::Set(df, 1.33335581e-3f);
  p = hn::MulAdd(p, f, hn::Set(df, 9.61812911e-3f));
  p = hn::MulAdd(p, f, hn::Set(df, 5.55041087e-2f));
  p = hn::MulAdd(p, f, hn::Set(df, 2.40226507e-1f));
  p = hn::MulAdd(p, f, hn::Set(df, 6.93147181e-1f));
  p = hn::MulAdd(p, f, hn::Set(df, 1.0f));
  const Int exponent = hn::ShiftLeft<23>(hn::Add(whole, hn::Set(di, 127)));
  return hn::Mul(p, hn::BitCast(df, exponent));
}

/// Writes ω(p, q) of eq. omega for the pixels p = u … u + lanes − 1 and every tap; 0 where q is outside the view.
HWY_INLINE void fill_weights(const AggregationRow& row, int u, float* weights) {
  const Floats df;
  const Ints di;
  const int lanes = static_cast<int>(hn::Lanes(df));
  const Int centre = load_widened(row.grey[static_cast<std::size_t>(row.radius)] + u);
  const Int columns = hn::Iota(di, u);
  for (std::size_t t = 0; t < row.taps.size(); ++t) {
    const Tap tap = row.taps[t];
    const auto r = static_cast<std::size_t>(tap.dv + row.radius);
    const Float difference = hn::ConvertTo(df, hn::Sub(centre, load_widened(row.grey[r] + u + tap.du)));
    const Float exponent =
        hn::MulAdd(hn::Mul(difference, difference), hn::Set(df, row.colour_log2), hn::Set(df, row.tap_log2[t]));
    Float weight = power_of_two(exponent);
    const int lowest = row.shift == 0 ? 0 : row.first[r];
    if (u + tap.du < lowest || u + tap.du + lanes > row.width) {
      const Int q = hn::Add(columns, hn::Set(di, tap.du));
      const auto inside = hn::And(hn::Gt(q, hn::Set(di, lowest - 1)), hn::Lt(q, hn::Set(di, row.width)));
      weight = hn::IfThenElseZero(hn::RebindMask(df, inside), weight);
    }
    hn::StoreU(weight, df, weights + t * static_cast<std::size_t>(lanes));
  }
}

/// Σ ω(p, q) c(q, d) for `planes` consecutive disparities at once, so that a weight is loaded once for all of them.
template <int planes>
HWY_INLINE void aggregate_planes(const AggregationRow& row, int u, int d, const float* weights, float* energies) {
  const Floats df;
  const std::size_t lanes = hn::Lanes(df);
  static_assert(planes == 1 || planes == 4 || planes == 8);
  Float e0 = hn::Zero(df), e1 = e0, e2 = e0, e3 = e0, e4 = e0, e5 = e0, e6 = e0, e7 = e0;
  const std::ptrdiff_t step = row.plane + row.shift;
  const std::ptrdiff_t start = u + d * step;
  for (std::size_t t = 0; t < row.taps.size(); ++t) {
    const Tap tap = row.taps[t];
    const float* cost = row.cost[static_cast<std::size_t>(tap.dv + row.radius)] + start + tap.du;
    const Float weight = hn::LoadU(df, weights + t * lanes);
    e0 = hn::MulAdd(weight, hn::LoadU(df, cost), e0);
    if constexpr (planes >= 4) {
      e1 = hn::MulAdd(weight, hn::LoadU(df, cost + step), e1);
      e2 = hn::MulAdd(weight, hn::LoadU(df, cost + 2 * step), e2);
      e3 = hn::MulAdd(weight, hn::LoadU(df, cost + 3 * step), e3);
    }
    if constexpr (planes >= 8) {
      e4 = hn::MulAdd(weight, hn::LoadU(df, cost + 4 * step), e4);
      e5 = hn::MulAdd(weight, hn::LoadU(df, cost + 5 * step), e5);
      e6 = hn::MulAdd(weight, hn::LoadU(df, cost + 6 * step), e6);
      e7 = hn::MulAdd(weight, hn::LoadU(df, cost + 7 * step), e7);
    }
  }
  float* out = energies + static_cast<std::size_t>(d) * lanes;
  hn::StoreU(e0, df, out);
  if constexpr (planes >= 4) {
    hn::StoreU(e1, df, out + lanes);
    hn::StoreU(e2, df, out + 2 * lanes);
    hn::StoreU(e3, df, out + 3 * lanes);
  }
  if constexpr (planes >= 8) {
    hn::StoreU(e4, df, out + 4 * lanes);
    hn::StoreU(e5, df, out + 5 * lanes);
    hn::StoreU(e6, df, out + 6 * lanes);
    hn::StoreU(e7, df, out + 7 * lanes);
  }
}

/// Last disparity at which the pixels u … have a counterpart; negative where none.
HWY_INLINE Int last_disparity(const AggregationRow& row, int u) {
  const Ints di;
  const Int columns = hn::Iota(di, u);
  const Int largest = hn::Set(di, row.disparities - 1);
  const Int first = hn::Set(di, row.first[static_cast<std::size_t>(row.radius)]);
  if (row.shift == 0) return hn::Min(largest, hn::Sub(columns, first));
  const Int bound = hn::Min(largest, hn::Sub(hn::Set(di, row.width - 1), columns));
  return hn::IfThenElse(hn::Lt(columns, first), hn::Set(di, -1), bound);
}

/// E_d(p, d) near the border, where the common view, and so the sum of the weights, depends on d.
HWY_INLINE void aggregate_border(const AggregationRow& row, int u, const float* weights, float* energies) {
  const Floats df;
  const Ints di;
  const std::size_t lanes = hn::Lanes(df);
  const Int columns = hn::Iota(di, u);
  const Int last = last_disparity(row, u);
  const Float never = hn::Set(df, std::numeric_limits<float>::infinity());
  for (int d = 0; d < row.disparities; ++d) {
    Float energy = hn::Zero(df);
    Float sum = hn::Zero(df);
    for (std::size_t t = 0; t < row.taps.size(); ++t) {
      const Tap tap = row.taps[t];
      const auto r = static_cast<std::size_t>(tap.dv + row.radius);
      const Int q = hn::Add(columns, hn::Set(di, tap.du));
      const auto seen =
          row.shift == 0 ? hn::Gt(q, hn::Set(di, row.first[r] + d - 1)) : hn::Lt(q, hn::Set(di, row.width - d));
      const Float weight = hn::IfThenElseZero(hn::RebindMask(df, seen), hn::LoadU(df, weights + t * lanes));
      const float* cost = row.cost[r] + u + tap.du + d * (row.plane + row.shift);
      energy = hn::MulAdd(weight, hn::LoadU(df, cost), energy);
      sum = hn::Add(sum, weight);
    }
    const auto possible = hn::RebindMask(df, hn::Gt(last, hn::Set(di, d - 1)));
    hn::StoreU(hn::IfThenElse(possible, hn::Div(energy, sum), never), df,
               energies + static_cast<std::size_t>(d) * lanes);
  }
}

/// Whether the whole window of the pixels u … u + lanes − 1 has a counterpart at every disparity.
bool inside_common_view(const AggregationRow& row, int u, int lanes) {
  if (u - row.radius < 0 || u + lanes - 1 + row.radius >= row.width) return false;
  int first = 0;
  for (const Tap& tap : row.taps) first = std::max(first, row.first[static_cast<std::size_t>(tap.dv + row.radius)]);
  if (row.shift == 0) return u - row.radius - (row.disparities - 1) >= first;
  return u - row.radius >= first && u + lanes - 1 + row.radius + row.disparities - 1 < row.width;
}

void aggregate(const AggregationRow& row, int u, const float* weights, float* energies) {
  int d = 0;
  for (; d + 8 <= row.disparities; d += 8) aggregate_planes<8>(row, u, d, weights, energies);
  for (; d + 4 <= row.disparities; d += 4) aggregate_planes<4>(row, u, d, weights, energies);
  for (; d < row.disparities; ++d) aggregate_planes<1>(row, u, d, weights, energies);
}

/// Winner-take-all over the energies of the pixels u … u + lanes − 1; the smaller disparity wins a tie.
HWY_INLINE Int take_winner(int disparities, const float* energies) {
  const Floats df;
  const std::size_t lanes = hn::Lanes(df);
  Float best = hn::Set(df, std::numeric_limits<float>::infinity());
  Float winner = hn::Set(df, -1.0f);
  for (int d = 0; d < disparities; ++d) {
    const Float energy = hn::LoadU(df, energies + static_cast<std::size_t>(d) * lanes);
    const auto better = hn::Lt(energy, best);
    best = hn::Min(energy, best);
    winner = hn::IfThenElse(better, hn::Set(df, static_cast<float>(d)), winner);
  }
  return hn::ConvertTo(Ints(), winner);
}

/// Eq. subpixel for one pixel: NaN when the winner has no neighbour on one side.
float sub_pixel_offset(const float* energies, std::size_t lanes, std::size_t lane, int winner, int last) {
  if (winner <= 0 || winner >= last) return std::numeric_limits<float>::quiet_NaN();
  const float* at = energies + static_cast<std::size_t>(winner) * lanes + lane;
  const float before = *(at - lanes);
  const float after = *(at + lanes);
  const float curvature = 2 * before + 2 * after - 4 * *at;
  return curvature > 0 ? (before - after) / curvature : 0;
}

void choose_row(const AggregationRow& row, const AggregationScratch& scratch, const WinnerRow& winners) {
  const Ints di;
  const std::size_t lanes = hn::Lanes(di);
  HWY_ALIGN std::int32_t winner[HWY_MAX_BYTES / sizeof(std::int32_t)];
  HWY_ALIGN std::int32_t last[HWY_MAX_BYTES / sizeof(std::int32_t)];
  for (int u = 0; u < row.width; u += static_cast<int>(lanes)) {
    fill_weights(row, u, scratch.weights);
    if (inside_common_view(row, u, static_cast<int>(lanes))) {
      // Every disparity has the same sum of weights, which changes neither the winner nor the parabola.
      aggregate(row, u, scratch.weights, scratch.energies);
    } else {
      aggregate_border(row, u, scratch.weights, scratch.energies);
    }
    hn::Store(take_winner(row.disparities, scratch.energies), di, winner);
    hn::Store(last_disparity(row, u), di, last);
    const std::size_t columns = std::min(lanes, static_cast<std::size_t>(row.width - u));
    for (std::size_t lane = 0; lane < columns; ++lane) {
      winners.winner[static_cast<std::size_t>(u) + lane] = static_cast<std::int16_t>(winner[lane]);
      if (winners.offset == nullptr) continue;
      winners.offset[static_cast<std::size_t>(u) + lane] =
          sub_pixel_offset(scratch.energies, lanes, lane, winner[lane], last[lane]);
    }
  }
}

std::size_t lane_count() {
  return hn::Lanes(Floats());
}
const char* name_of_target() {
  return hwy::TargetName(HWY_TARGET);
}

}  // namespace roadstereo::cpu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace roadstereo::cpu {

HWY_EXPORT(slide_products);
HWY_EXPORT(block_statistics);
HWY_EXPORT(correlation_row);
HWY_EXPORT(choose_row);
HWY_EXPORT(lane_count);
HWY_EXPORT(name_of_target);

void slide_products(const std::int16_t* entering_ref, const std::int16_t* entering_tar, const std::int16_t* leaving_ref,
                    const std::int16_t* leaving_tar, int width, std::int32_t* sums) {
  HWY_DYNAMIC_DISPATCH(slide_products)(entering_ref, entering_tar, leaving_ref, leaving_tar, width, sums);
}

void block_statistics(const std::int32_t* column_sums, const std::int32_t* column_squares, int block_radius,
                      int pixels_in_block, float noise_variance, int width, const BlockStatisticsRow& out) {
  HWY_DYNAMIC_DISPATCH(block_statistics)
  (column_sums, column_squares, block_radius, pixels_in_block, noise_variance, width, out);
}

void correlation_row(const std::int32_t* column_sums, const BlockStatistics& ref, const BlockStatistics& tar,
                     int block_radius, int pixels_in_block, int first, int last, float* cost) {
  HWY_DYNAMIC_DISPATCH(correlation_row)(column_sums, ref, tar, block_radius, pixels_in_block, first, last, cost);
}

void choose_row(const AggregationRow& row, const AggregationScratch& scratch, const WinnerRow& winners) {
  HWY_DYNAMIC_DISPATCH(choose_row)(row, scratch, winners);
}

std::size_t weight_scratch_size(std::size_t taps) {
  return taps * HWY_DYNAMIC_DISPATCH(lane_count)();
}
std::size_t energy_scratch_size(int disparities) {
  return static_cast<std::size_t>(disparities) * HWY_DYNAMIC_DISPATCH(lane_count)();
}

std::string target_name() {
  return HWY_DYNAMIC_DISPATCH(name_of_target)();
}

}  // namespace roadstereo::cpu
#endif  // HWY_ONCE
