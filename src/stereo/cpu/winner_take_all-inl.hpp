// Winner-take-all with the prior, and sub-pixel offset, of one strip.

#include <hwy/highway.h>

#include <algorithm>

#include "stereo/cpu/aggregation.hpp"
#include "stereo/sub_pixel.hpp"

#if defined(ROADSTEREO_STEREO_CPU_WINNER_TAKE_ALL_INL) == defined(HWY_TARGET_TOGGLE)  // once for every instruction set
#ifdef ROADSTEREO_STEREO_CPU_WINNER_TAKE_ALL_INL
#undef ROADSTEREO_STEREO_CPU_WINNER_TAKE_ALL_INL
#else
#define ROADSTEREO_STEREO_CPU_WINNER_TAKE_ALL_INL
#endif
#include <hwy/contrib/math/math-inl.h>

#include "stereo/cpu/vector-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace roadstereo::cpu::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET == HWY_SCALAR
/// The smallest lane of each of four vectors.
template <class D>
HWY_INLINE void min_lanes(D /*d*/, const hn::Vec<D>* of, hn::TFromD<D>* smallest) {
  for (int p = 0; p < 4; ++p) smallest[p] = hn::GetLane(of[p]);
}
#else
/// smallest[0 … 3] = the smallest of those lanes of v that lie at the same place of a 128-bit block.
template <class D>
HWY_INLINE void fold_blocks(D d, hn::Vec<D> v, hn::TFromD<D>* smallest) {
  if constexpr (hn::MaxLanes(D()) > 4) {
    const hn::Half<D> half;
    fold_blocks(half, hn::Min(hn::LowerHalf(half, v), hn::UpperHalf(half, v)), smallest);
  } else {
    hn::StoreU(v, d, smallest);
  }
}

/// The smallest lane of each of four vectors. They are halved side by side: the lanes of a 128-bit block become a b a b
/// and c d c d, then a b c d.
template <class D>
HWY_INLINE void min_lanes(D d, const hn::Vec<D>* of, hn::TFromD<D>* smallest) {
  const hn::Repartition<std::uint64_t, D> pairs;
  const auto ab = hn::Min(hn::InterleaveLower(d, of[0], of[1]), hn::InterleaveUpper(d, of[0], of[1]));
  const auto cd = hn::Min(hn::InterleaveLower(d, of[2], of[3]), hn::InterleaveUpper(d, of[2], of[3]));
  const auto wide_ab = hn::BitCast(pairs, ab), wide_cd = hn::BitCast(pairs, cd);
  const auto abcd = hn::Min(hn::BitCast(d, hn::InterleaveLower(pairs, wide_ab, wide_cd)),
                            hn::BitCast(d, hn::InterleaveUpper(pairs, wide_ab, wide_cd)));
  fold_blocks(d, abcd, smallest);
}
#endif

/// The energies of four pixels, as they are.
struct PlainEnergies {
  const float* energies;
  std::ptrdiff_t pitch;

  HWY_INLINE Float at(int p, int d) const { return hn::Load(Floats(), energies + p * pitch + d); }
};

/// The energies of four pixels whose disparities fill one vector, infinite behind the last: they stay in registers.
struct HeldEnergies {
  Float of_pixel[4];

  template <class Energies>
  HWY_INLINE HeldEnergies(const Energies& energies, int disparities) {
    const Floats df;
    const auto searched = hn::FirstN(df, static_cast<std::size_t>(disparities));
    for (int p = 0; p < 4; ++p) of_pixel[p] = hn::IfThenElse(searched, energies.at(p, 0), hn::Set(df, infinity));
  }
  HWY_INLINE Float at(int p, int /*d*/) const { return of_pixel[p]; }
};

/// The smallest energy of each of four pixels.
template <class Energies>
HWY_INLINE void min_energies(const Energies& energies, int disparities, float* smallest) {
  const Floats df;
  const int lanes = static_cast<int>(hn::Lanes(df));
  Float vectors[4];
  for (int p = 0; p < 4; ++p) vectors[p] = energies.at(p, 0);
  for (int d = lanes; d < disparities; d += lanes) {
    for (int p = 0; p < 4; ++p) vectors[p] = hn::Min(vectors[p], energies.at(p, d));
  }
  min_lanes(df, vectors, smallest);
}

/// The energies of four pixels with what they pay for their distance from the prior.
template <class Energies>
struct RegularisedCosts {
  const Energies& plain;
  float low[4], high[4], weight[4];
  float truncation;

  HWY_INLINE RegularisedCosts(const AggregationRow& row, const Energies& energies, int column)
      : plain(energies), truncation(row.prior.truncation) {
    const hn::CappedTag<float, 4> d;
    float smallest[4];
    min_energies(plain, row.disparities, smallest);
    for (std::size_t p = 0; p < 4; p += hn::Lanes(d)) {
      const auto from = hn::LoadU(d, row.prior.low + column + p), to = hn::LoadU(d, row.prior.high + column + p);
      const auto known = hn::Eq(from, from);
      const auto cost = hn::Add(hn::LoadU(d, smallest + p), hn::Set(d, prior_cost_offset));
      const auto share = hn::Min(hn::Set(d, 1.0f), hn::Div(cost, hn::Set(d, prior_full_cost)));
      hn::StoreU(hn::IfThenElseZero(known, from), d, low + p);
      hn::StoreU(hn::IfThenElseZero(known, to), d, high + p);
      hn::StoreU(hn::IfThenElseZero(known, hn::Mul(hn::Set(d, row.prior.weight), share)), d, weight + p);
    }
  }

  HWY_INLINE Float at(int p, int d) const {
    const Floats df;
    const Float here = hn::ConvertTo(df, count_from(d));
    const Float outside = hn::Max(hn::Sub(hn::Set(df, low[p]), here), hn::Sub(here, hn::Set(df, high[p])));
    const Float away = hn::Max(outside, hn::Zero(df));
    return hn::MulAdd(hn::Min(away, hn::Set(df, truncation)), hn::Set(df, weight[p]), plain.at(p, d));
  }
};

/// Winner-take-all of four pixels: winners[p] = the first d at which the energy is smallest.
template <class Energies>
HWY_INLINE void take_winners(const Energies& energies, int disparities, std::int32_t* winners) {
  const Floats df;
  const int lanes = static_cast<int>(hn::Lanes(df));
  float smallest[4];
  min_energies(energies, disparities, smallest);
  for (int p = 0; p < 4; ++p) {
    const Float lowest = hn::Set(df, smallest[p]);
    winners[p] = 0;
    for (int d = 0; d < disparities; d += lanes) {
      const auto first = hn::FindFirstTrue(df, hn::Eq(energies.at(p, d), lowest));
      if (first < 0) continue;
      winners[p] = d + static_cast<std::int32_t>(first);
      break;
    }
  }
}

/// Winners of a strip, with the energies on either side that the parabola needs.
struct StripWinners {
  std::int32_t winner[strip_columns];
  float before[strip_columns], best[strip_columns], after[strip_columns];
};

/// Winners of four pixels from column on. Energies behind the last disparity are infinite up to a whole vector.
HWY_INLINE void find_winners_of_four(const AggregationRow& row, int column, float* energies, std::int32_t* winners) {
  const int lanes = static_cast<int>(hn::Lanes(Floats()));
  const PlainEnergies plain{energies, row.pitch};
  if (row.disparities <= lanes) {
    const HeldEnergies held(plain, row.disparities);
    if (row.prior.low == nullptr) {
      take_winners(held, lanes, winners);
    } else {
      const RegularisedCosts regularised(row, held, column);
      take_winners(HeldEnergies(regularised, lanes), lanes, winners);
    }
    return;
  }
  for (int p = 0; p < 4; ++p) {
    std::fill(energies + p * row.pitch + row.disparities, energies + (p + 1) * row.pitch, infinity);
  }
  if (row.prior.low == nullptr) {
    take_winners(plain, row.disparities, winners);
  } else {
    take_winners(RegularisedCosts(row, plain, column), row.disparities, winners);
  }
}

HWY_INLINE void find_winners(const AggregationRow& row, int strip, float* energies, int columns, StripWinners& found) {
  for (int column = 0; column < columns; column += 4) {
    float* of_four = energies + column * row.pitch;
    find_winners_of_four(row, strip + column, of_four, found.winner + column);
    for (int p = 0; p < 4; ++p) {
      // A winner at an end has no neighbour there: what is read instead is not used.
      const int winner = std::clamp(found.winner[column + p], 1, std::max(1, row.disparities - 2));
      const float* at = of_four + p * row.pitch + winner;
      found.before[column + p] = at[-1];
      found.best[column + p] = at[0];
      found.after[column + p] = at[1];
    }
  }
}

/// See `gaussian_vertex`.
HWY_INLINE Float gaussian_vertices(Float before, Float best, Float after, Float floor) {
  const Floats df;
  const auto raised = [&](Float cost) {
    return hn::Add(hn::Max(hn::Sub(hn::Set(df, 1.0f), cost), hn::Zero(df)), floor);
  };
  const Float low = raised(before), at = raised(best), high = raised(after);
  const Float curvature = hn::Log(df, hn::Div(hn::Mul(at, at), hn::Mul(low, high)));
  const Float slope = hn::Mul(hn::Set(df, 0.5f), hn::Log(df, hn::Div(high, low)));
  return hn::Div(slope, hn::Max(curvature, hn::Set(df, min_curvature)));
}

/// Writes winners, offsets and variances of a strip: for every column −1 and NaN where nothing can match, else the
/// winner and its offset, NaN where the winner has no neighbour on one side. The variance is derived in
/// stereo/window.hpp.
HWY_INLINE void write_winners(const AggregationRow& row, int strip, int columns, const StripWinners& found,
                              const WinnerRow& out) {
  const Floats df;
  const Ints di;
  const hn::Rebind<std::int16_t, Ints> ds;
  const int lanes = static_cast<int>(hn::Lanes(di));
  const Float nan = hn::Set(df, std::numeric_limits<float>::quiet_NaN());
  for (int i = 0; i < columns; i += lanes) {
    const Int column = hn::Mul(count_from(strip + i), hn::Set(di, row.pixel_step));
    const Int seen = hn::Min(hn::Sub(column, hn::Set(di, row.centre.first_visible)), hn::Set(di, row.disparities - 1));
    const Int last = hn::IfThenElse(hn::Gt(column, hn::Set(di, row.centre.last_valid)), hn::Set(di, -1), seen);
    const Int winner = hn::LoadU(di, found.winner + i);
    const Int chosen = hn::IfThenElse(hn::Lt(last, hn::Zero(di)), hn::Set(di, -1), winner);
    const int at = strip - row.first + i;
    hn::StoreU(hn::DemoteTo(ds, chosen), ds, out.winner + at);
    if (out.offset == nullptr) continue;
    const Float before = hn::LoadU(df, found.before + i), after = hn::LoadU(df, found.after + i);
    const Float best = hn::LoadU(df, found.best + i);
    const Float curvature = hn::Sub(hn::Add(before, after), hn::Add(best, best));
    const auto curved = hn::Gt(curvature, hn::Set(df, min_curvature));
    const Float half = hn::Set(df, 0.5f);
    const Float peak = row.peak_floor > 0 ? gaussian_vertices(before, best, after, hn::Set(df, row.peak_floor))
                                          : hn::Div(hn::Mul(half, hn::Sub(before, after)), curvature);
    const Float vertex = hn::IfThenElseZero(curved, peak);
    const Float noise =
        hn::Div(hn::Mul(hn::Set(df, 2 / row.effective_samples), hn::Max(best, hn::Zero(df))), curvature);
    // With a prior the winner need not be a minimum of the costs.
    const auto sure = hn::Lt(noise, hn::Set(df, low_noise_variance));
    const Float max_offset = hn::IfThenElse(sure, hn::Set(df, low_noise_truncation_px), half);
    const Float offset = hn::Clamp(vertex, hn::Neg(max_offset), max_offset);
    const Float outside = hn::Sub(vertex, offset);
    const Float variance = hn::IfThenElse(curved, hn::MulAdd(outside, outside, noise), hn::Set(df, infinity));
    const auto bracketed = hn::And(hn::Gt(winner, hn::Zero(di)), hn::Lt(winner, last));
    hn::StoreU(hn::IfThenElse(hn::RebindMask(df, bracketed), offset, nan), df, out.offset + at);
    hn::StoreU(hn::IfThenElse(hn::RebindMask(df, bracketed), variance, hn::Set(df, infinity)), df, out.variance + at);
  }
}

}  // namespace roadstereo::cpu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
