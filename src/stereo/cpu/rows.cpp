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
                    const std::int16_t* leaving_tar, int first, int end, std::int32_t* sums) {
  const Ints d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  for (int u = first; u < end; u += lanes) {
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
                      int pixels_in_block, float noise_variance, int first, int end, const BlockStatisticsRow& out) {
  const Ints di;
  const Floats df;
  const int lanes = static_cast<int>(hn::Lanes(di));
  const Float n = hn::Set(df, static_cast<float>(pixels_in_block));
  const Float inverse_n = hn::Set(df, 1.0f / static_cast<float>(pixels_in_block));
  for (int u = first; u < end; u += lanes) {
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
/// Returns one over their sum.
HWY_INLINE Float fill_weights(const AggregationRow& row, int u, float* weights) {
  const Floats df;
  const Ints di;
  const int lanes = static_cast<int>(hn::Lanes(df));
  const Int centre = load_widened(row.grey + u);
  const Int columns = hn::Iota(di, u);
  Float sum = hn::Zero(df);
  for (const RowTap& tap : row.taps) {
    const Float difference = hn::ConvertTo(df, hn::Sub(centre, load_widened(tap.grey + u + tap.du)));
    const Float exponent =
        hn::MulAdd(hn::Mul(difference, difference), hn::Set(df, row.colour_log2), hn::Set(df, tap.log2_weight));
    Float weight = power_of_two(exponent);
    const int lowest = row.shift == 0 ? 0 : tap.first_column;
    if (u + tap.du < lowest || u + tap.du + lanes > row.width) {
      const Int q = hn::Add(columns, hn::Set(di, tap.du));
      const auto inside = hn::And(hn::Gt(q, hn::Set(di, lowest - 1)), hn::Lt(q, hn::Set(di, row.width)));
      weight = hn::IfThenElseZero(hn::RebindMask(df, inside), weight);
    }
    hn::StoreU(weight, df, weights);
    weights += lanes;
    sum = hn::Add(sum, weight);
  }
  return hn::Div(hn::Set(df, 1.0f), sum);
}

/// Disparities that are aggregated together: a weight is loaded once for all of them.
constexpr int planes_together = 8;

/// Pixels of a row that are aggregated together for one group of disparities, in vectors: their costs lie one after the
/// other in memory, and their weights stay in the cache for the next group.
constexpr int strip_vectors = 16;

/// E_d(p, d) of eq. fbs for `planes` consecutive disparities; every pixel of the window has a counterpart.
template <int planes>
HWY_INLINE void aggregate_planes(const AggregationRow& row, int u, int d, const float* weights, Float inverse_sum,
                                 float* energies) {
  static_assert(planes == 1 || planes == 4 || planes == planes_together);
  const Floats df;
  const std::size_t lanes = hn::Lanes(df);
  Float e0 = hn::Zero(df), e1 = e0, e2 = e0, e3 = e0, e4 = e0, e5 = e0, e6 = e0, e7 = e0;
  const std::ptrdiff_t step = row.plane + row.shift;
  const std::ptrdiff_t start = u + d * step;
  for (const RowTap& tap : row.taps) {
    const float* cost = tap.cost + start + tap.du;
    const Float weight = hn::LoadU(df, weights);
    weights += lanes;
    e0 = hn::MulAdd(weight, hn::LoadU(df, cost), e0);
    if constexpr (planes >= 4) {
      e1 = hn::MulAdd(weight, hn::LoadU(df, cost + step), e1);
      e2 = hn::MulAdd(weight, hn::LoadU(df, cost + 2 * step), e2);
      e3 = hn::MulAdd(weight, hn::LoadU(df, cost + 3 * step), e3);
    }
    if constexpr (planes == planes_together) {
      e4 = hn::MulAdd(weight, hn::LoadU(df, cost + 4 * step), e4);
      e5 = hn::MulAdd(weight, hn::LoadU(df, cost + 5 * step), e5);
      e6 = hn::MulAdd(weight, hn::LoadU(df, cost + 6 * step), e6);
      e7 = hn::MulAdd(weight, hn::LoadU(df, cost + 7 * step), e7);
    }
  }
  hn::StoreU(hn::Mul(e0, inverse_sum), df, energies);
  if constexpr (planes >= 4) {
    hn::StoreU(hn::Mul(e1, inverse_sum), df, energies + lanes);
    hn::StoreU(hn::Mul(e2, inverse_sum), df, energies + 2 * lanes);
    hn::StoreU(hn::Mul(e3, inverse_sum), df, energies + 3 * lanes);
  }
  if constexpr (planes == planes_together) {
    hn::StoreU(hn::Mul(e4, inverse_sum), df, energies + 4 * lanes);
    hn::StoreU(hn::Mul(e5, inverse_sum), df, energies + 5 * lanes);
    hn::StoreU(hn::Mul(e6, inverse_sum), df, energies + 6 * lanes);
    hn::StoreU(hn::Mul(e7, inverse_sum), df, energies + 7 * lanes);
  }
}

/// The same for disparities first … last − 1, at most `planes_together` of them.
HWY_INLINE void aggregate_inside(const AggregationRow& row, int u, int first, int last, const float* weights,
                                 Float inverse_sum, float* energies) {
  const std::size_t lanes = hn::Lanes(Floats());
  if (last - first == planes_together) {
    aggregate_planes<planes_together>(row, u, first, weights, inverse_sum, energies);
    return;
  }
  int d = first;
  for (; d + 4 <= last; d += 4, energies += 4 * lanes) aggregate_planes<4>(row, u, d, weights, inverse_sum, energies);
  for (; d < last; ++d, energies += lanes) aggregate_planes<1>(row, u, d, weights, inverse_sum, energies);
}

/// Last disparity at which the pixels u … have a counterpart; negative where none.
HWY_INLINE Int last_disparity(const AggregationRow& row, int u) {
  const Ints di;
  const Int columns = hn::Iota(di, u);
  const Int largest = hn::Set(di, row.disparities - 1);
  const Int first = hn::Set(di, row.first_column);
  if (row.shift == 0) return hn::Min(largest, hn::Sub(columns, first));
  const Int bound = hn::Min(largest, hn::Sub(hn::Set(di, row.width - 1), columns));
  return hn::IfThenElse(hn::Lt(columns, first), hn::Set(di, -1), bound);
}

/// E_d(p, d) near the border, where the common view, and so the sum of the weights, depends on d.
void aggregate_border(const AggregationRow& row, int u, int first, int last, const float* weights, float* energies) {
  const Floats df;
  const Ints di;
  const std::size_t lanes = hn::Lanes(df);
  const Int columns = hn::Iota(di, u);
  const Int last_possible = last_disparity(row, u);
  const Float never = hn::Set(df, std::numeric_limits<float>::infinity());
  for (int d = first; d < last; ++d, energies += lanes) {
    Float energy = hn::Zero(df);
    Float sum = hn::Zero(df);
    const float* weight_of_tap = weights;
    for (const RowTap& tap : row.taps) {
      const Int q = hn::Add(columns, hn::Set(di, tap.du));
      const auto seen =
          row.shift == 0 ? hn::Gt(q, hn::Set(di, tap.first_column + d - 1)) : hn::Lt(q, hn::Set(di, row.width - d));
      const Float weight = hn::IfThenElseZero(hn::RebindMask(df, seen), hn::LoadU(df, weight_of_tap));
      weight_of_tap += lanes;
      const float* cost = tap.cost + u + tap.du + d * (row.plane + row.shift);
      energy = hn::MulAdd(weight, hn::LoadU(df, cost), energy);
      sum = hn::Add(sum, weight);
    }
    const auto possible = hn::RebindMask(df, hn::Gt(last_possible, hn::Set(di, d - 1)));
    hn::StoreU(hn::IfThenElse(possible, hn::Div(energy, sum), never), df, energies);
  }
}

/// Whether the whole window of the pixels u … u + lanes − 1 has a counterpart at every disparity below `last`.
bool inside_common_view(const AggregationRow& row, int u, int lanes, int last) {
  const int left = u - row.radius;
  const int right = u + lanes - 1 + row.radius;
  if (left < 0 || right >= row.width) return false;
  if (row.shift == 0) return left - (last - 1) >= row.common_first_column;
  return left >= row.common_first_column && right + last - 1 < row.width;
}

/// Winner-take-all in passing: the best energy so far of each pixel, its disparity, and the energies on either side of
/// it that the parabola needs. One vector each, in memory.
struct RunningWinner {
  float *best, *winner, *before, *after, *previous;

  static constexpr std::size_t vectors = 5;
  RunningWinner(float* at, std::size_t lanes)
      : best(at), winner(at + lanes), before(at + 2 * lanes), after(at + 3 * lanes), previous(at + 4 * lanes) {}
};

void reset(const RunningWinner& state) {
  const Floats df;
  hn::StoreU(hn::Set(df, std::numeric_limits<float>::infinity()), df, state.best);
  hn::StoreU(hn::Set(df, -1.0f), df, state.winner);
  for (float* energy : {state.before, state.after, state.previous}) hn::StoreU(hn::Zero(df), df, energy);
}

/// Lets the energies of the disparities first … last − 1 compete; the smaller disparity wins a tie.
HWY_INLINE void compete(const float* energies, int first, int last, const RunningWinner& state) {
  const Floats df;
  Float best = hn::LoadU(df, state.best), winner = hn::LoadU(df, state.winner), before = hn::LoadU(df, state.before);
  Float after = hn::LoadU(df, state.after), previous = hn::LoadU(df, state.previous);
  for (int d = first; d < last; ++d, energies += hn::Lanes(df)) {
    const Float energy = hn::LoadU(df, energies);
    after = hn::IfThenElse(hn::Eq(winner, hn::Set(df, static_cast<float>(d - 1))), energy, after);
    const auto better = hn::Lt(energy, best);
    best = hn::Min(energy, best);
    winner = hn::IfThenElse(better, hn::Set(df, static_cast<float>(d)), winner);
    before = hn::IfThenElse(better, previous, before);
    previous = energy;
  }
  hn::StoreU(best, df, state.best);
  hn::StoreU(winner, df, state.winner);
  hn::StoreU(before, df, state.before);
  hn::StoreU(after, df, state.after);
  hn::StoreU(previous, df, state.previous);
}

/// Writes the winners of the pixels u … and their sub-pixel offsets (eq. subpixel): NaN when the winner has no
/// neighbour on one side.
void write_winners(const AggregationRow& row, int u, const RunningWinner& state, const WinnerRow& out) {
  const Ints di;
  const std::size_t lanes = hn::Lanes(di);
  HWY_ALIGN std::int32_t last[HWY_MAX_BYTES / sizeof(std::int32_t)];
  hn::Store(last_disparity(row, u), di, last);
  const std::size_t columns = std::min(lanes, static_cast<std::size_t>(row.width - u));
  for (std::size_t lane = 0; lane < columns; ++lane) {
    const std::size_t column = static_cast<std::size_t>(u) + lane;
    const auto winner = static_cast<std::int32_t>(state.winner[lane]);
    out.winner[column] = static_cast<std::int16_t>(winner);
    if (out.offset == nullptr) continue;
    const float curvature = 2 * state.before[lane] + 2 * state.after[lane] - 4 * state.best[lane];
    const float offset = curvature > 0 ? (state.before[lane] - state.after[lane]) / curvature : 0;
    const bool bracketed = winner > 0 && winner < last[lane];
    out.offset[column] = bracketed ? offset : std::numeric_limits<float>::quiet_NaN();
  }
}

void choose_row(const AggregationRow& row, float* scratch, const WinnerRow& winners) {
  const std::size_t lanes = hn::Lanes(Floats());
  const int strip = strip_vectors * static_cast<int>(lanes);
  const std::size_t weights_of_vector = row.taps.size() * lanes;
  float* energies = scratch;
  float* states = energies + planes_together * lanes;
  float* inverse_sums = states + strip_vectors * RunningWinner::vectors * lanes;
  float* weights = inverse_sums + strip_vectors * lanes;
  const auto state_of = [&](std::size_t i) {
    return RunningWinner(states + i * RunningWinner::vectors * lanes, lanes);
  };

  for (int begin = row.begin; begin < row.end; begin += strip) {
    const int end = std::min(begin + strip, row.end);
    const auto each_vector = [&](auto body) {
      std::size_t i = 0;
      for (int u = begin; u < end; u += static_cast<int>(lanes), ++i) body(u, i);
    };
    each_vector([&](int u, std::size_t i) {
      hn::StoreU(fill_weights(row, u, weights + i * weights_of_vector), Floats(), inverse_sums + i * lanes);
      reset(state_of(i));
    });
    for (int first = 0; first < row.disparities; first += planes_together) {
      const int last = std::min(first + planes_together, row.disparities);
      each_vector([&](int u, std::size_t i) {
        if (inside_common_view(row, u, static_cast<int>(lanes), last)) {
          const Float inverse_sum = hn::LoadU(Floats(), inverse_sums + i * lanes);
          aggregate_inside(row, u, first, last, weights + i * weights_of_vector, inverse_sum, energies);
        } else {
          aggregate_border(row, u, first, last, weights + i * weights_of_vector, energies);
        }
        compete(energies, first, last, state_of(i));
      });
    }
    each_vector([&](int u, std::size_t i) { write_winners(row, u, state_of(i), winners); });
  }
}

std::size_t choose_row_scratch(std::size_t taps) {
  const std::size_t lanes = hn::Lanes(Floats());
  return lanes * (planes_together + strip_vectors * (RunningWinner::vectors + 1 + taps));
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
HWY_EXPORT(choose_row_scratch);
HWY_EXPORT(name_of_target);

void slide_products(const std::int16_t* entering_ref, const std::int16_t* entering_tar, const std::int16_t* leaving_ref,
                    const std::int16_t* leaving_tar, int first, int end, std::int32_t* sums) {
  HWY_DYNAMIC_DISPATCH(slide_products)(entering_ref, entering_tar, leaving_ref, leaving_tar, first, end, sums);
}

void block_statistics(const std::int32_t* column_sums, const std::int32_t* column_squares, int block_radius,
                      int pixels_in_block, float noise_variance, int first, int end, const BlockStatisticsRow& out) {
  HWY_DYNAMIC_DISPATCH(block_statistics)
  (column_sums, column_squares, block_radius, pixels_in_block, noise_variance, first, end, out);
}

void correlation_row(const std::int32_t* column_sums, const BlockStatistics& ref, const BlockStatistics& tar,
                     int block_radius, int pixels_in_block, int first, int last, float* cost) {
  HWY_DYNAMIC_DISPATCH(correlation_row)(column_sums, ref, tar, block_radius, pixels_in_block, first, last, cost);
}

void choose_row(const AggregationRow& row, float* scratch, const WinnerRow& winners) {
  HWY_DYNAMIC_DISPATCH(choose_row)(row, scratch, winners);
}

std::size_t choose_row_scratch(std::size_t taps) {
  return HWY_DYNAMIC_DISPATCH(choose_row_scratch)(taps);
}

std::string target_name() {
  return HWY_DYNAMIC_DISPATCH(name_of_target)();
}

}  // namespace roadstereo::cpu
#endif  // HWY_ONCE
