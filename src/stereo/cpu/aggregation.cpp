#include "stereo/cpu/aggregation.hpp"

#include <algorithm>
#include <limits>

#include "stereo/window.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "stereo/cpu/aggregation.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for every instruction set
//
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace roadstereo::cpu::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::ScalableTag<float>;
using Ints = hn::ScalableTag<std::int32_t>;
using Float = hn::Vec<Floats>;
using Int = hn::Vec<Ints>;

/// first, first + 1, … (hn::Iota of a variable goes through memory.)
template <class D>
HWY_INLINE hn::Vec<D> count_up(D d, int first) {
  return hn::Add(hn::Iota(d, 0), hn::Set(d, first));
}
HWY_INLINE Int count_from(int first) {
  return count_up(Ints(), first);
}

/// Neighbouring pixels that are aggregated at once: they share loads, and their sums run side by side. As many as the
/// registers hold, twice each for two vectors of disparities.
constexpr int block_columns = (HWY_TARGET <= HWY_AVX3 || HWY_ARCH_ARM_A64) ? 8 : 4;

constexpr float infinity = std::numeric_limits<float>::infinity();

/// Pixels are aggregated in pairs, because tap k of a pixel and tap k − 1 of the pixel one tap to its right meet at the
/// same cost: a window row of n taps is n + 1 steps, each a column of costs for both, with a weight of 0 where one of
/// them has no tap. The steps of all rows make one list, so that the innermost loop is long.
struct StepList {
  const float** cost;     ///< costs of the step for the pixels 0 and 1
  float* weights;         ///< of the blocks of a strip: for every block and step, its columns
  float* inverse_sums;    ///< 1 / Σ ω of the columns of a strip
  std::size_t count = 0;  ///< steps

  float* of_block(int block) const { return weights + static_cast<std::size_t>(block * block_columns) * count; }
};

/// Lists the costs of the steps.
HWY_INLINE void list_steps(const AggregationRow& row, StepList& steps) {
  for (const WindowRow& window : row.rows) {
    for (int i = -window.half; i <= window.half + 1; ++i) {
      steps.cost[steps.count++] = window.costs + std::ptrdiff_t{i} * row.step * row.pitch;
    }
  }
}

/// Gathers the weights of the steps for the columns of one strip: step k has tap k of the left pixels of pairs and
/// tap k − 1 of the right ones. A pixel is a right one when its column has the bit of the step.
HWY_INLINE void gather_weights(const AggregationRow& row, int strip, const StepList& steps) {
  const hn::CappedTag<float, block_columns> d;
  const hn::RebindToSigned<decltype(d)> dd;
  const int lanes = static_cast<int>(hn::Lanes(d));
  for (int i = 0; i < strip_columns; i += lanes) {
    const auto columns_of_step = hn::And(count_up(dd, i), hn::Set(dd, row.step));
    const auto right = hn::RebindMask(d, hn::Eq(columns_of_step, hn::Set(dd, row.step)));
    const float* const* weights = row.weights.data();
    float* out = steps.of_block(i / block_columns) + i % block_columns;
    auto sum = hn::Zero(d);
    for (const WindowRow& window : row.rows) {
      auto previous = hn::Zero(d);
      for (int k = 0; k < 2 * window.half + 1; ++k, out += block_columns) {
        const auto weight = hn::LoadU(d, *weights++ + strip + i);
        sum = hn::Add(sum, weight);
        hn::StoreU(hn::IfThenElse(right, previous, weight), d, out);
        previous = weight;
      }
      hn::StoreU(hn::IfThenElseZero(right, previous), d, out);
      out += block_columns;
    }
    hn::StoreU(hn::Div(hn::Set(d, 1.0f), sum), d, steps.inverse_sums + i);
  }
}

/// energies[p, d] = Σ_taps ω·c / Σ ω (eq. (11)) for the pixels p of a block and `vectors` vectors of disparities from
/// first_d on, whose window lies in the common view.
template <int vectors, int step_columns>
HWY_INLINE void aggregate_block(const AggregationRow& row, const StepList& steps, int column, int first_d,
                                float* energies) {
  const Floats df;
  const std::size_t lanes = hn::Lanes(df);
  const std::ptrdiff_t at = column * row.pitch + first_d;
  const int in_strip = (column - row.first) % strip_columns;
  Float energy[block_columns][vectors];
  for (auto& of_pixel : energy) {
    for (Float& e : of_pixel) e = hn::Zero(df);
  }
  const float* weight = steps.of_block(in_strip / block_columns);
  for (std::size_t step = 0; step < steps.count; ++step, weight += block_columns) {
    const float* cost = steps.cost[step] + at;
    for (int pair = 0; pair < block_columns / 2; ++pair) {
      const int p = pair / step_columns * 2 * step_columns + pair % step_columns;
      const int q = p + step_columns;
      const Float left = hn::Set(df, weight[p]), right = hn::Set(df, weight[q]);
      for (std::size_t i = 0; i < vectors; ++i) {
        const Float c = hn::Load(df, cost + p * row.pitch + i * lanes);
        energy[p][i] = hn::MulAdd(left, c, energy[p][i]);
        energy[q][i] = hn::MulAdd(right, c, energy[q][i]);
      }
    }
  }
  float* out = energies + in_strip * row.pitch + first_d;
  for (int p = 0; p < block_columns; ++p, out += row.pitch) {
    const Float inverse_sum = hn::Set(df, steps.inverse_sums[in_strip + p]);
    for (std::size_t i = 0; i < vectors; ++i) hn::Store(hn::Mul(energy[p][i], inverse_sum), df, out + i * lanes);
  }
}

/// The same without aggregation: energies[p, d] = c(p, d).
template <int vectors>
HWY_INLINE void copy_block(const AggregationRow& row, int column, int first_d, float* energies) {
  const Floats df;
  const std::size_t lanes = hn::Lanes(df);
  const float* cost = row.centre.costs + column * row.pitch + first_d;
  float* out = energies + (column - row.first) % strip_columns * row.pitch + first_d;
  for (int p = 0; p < block_columns; ++p, cost += row.pitch, out += row.pitch) {
    for (std::size_t i = 0; i < vectors; ++i) hn::Store(hn::Load(df, cost + i * lanes), df, out + i * lanes);
  }
}

/// The last disparity at which column i of a window row has a counterpart; negative where there is none.
HWY_INLINE int last_seen(const WindowRow& window, int i) {
  return i > window.last_valid ? -1 : i - window.first_visible;
}

/// The same for one vector of disparities of one pixel near the border, over the taps that have a counterpart; infinite
/// where the pixel itself has none.
HWY_INLINE void aggregate_border(const AggregationRow& row, int column, int d, float* energies) {
  const Floats df;
  const Ints di;
  const int lanes = static_cast<int>(hn::Lanes(df));
  const Float infinite_energy = hn::Set(df, infinity);
  float* out = energies + (column - row.first) % strip_columns * row.pitch + d;
  if (d > last_seen(row.centre, column)) {
    hn::Store(infinite_energy, df, out);
    return;
  }
  const Int disparity = count_from(d);
  Float energy = hn::Zero(df), sum = hn::Zero(df);
  const float* const* weight = row.weights.data();
  for (const WindowRow& window : row.rows) {
    for (int k = -window.half; k <= window.half; ++k, ++weight) {
      const int i = column + k * row.step;
      const int last = last_seen(window, i);
      if (last < d) continue;
      Float w = hn::Set(df, (*weight)[column]);
      if (last < d + lanes - 1) {
        w = hn::IfThenElseZero(hn::RebindMask(df, hn::Lt(disparity, hn::Set(di, last + 1))), w);
      }
      energy = hn::MulAdd(w, hn::Load(df, window.costs + i * row.pitch + d), energy);
      sum = hn::Add(sum, w);
    }
  }
  const auto seen = hn::RebindMask(df, hn::Lt(disparity, hn::Set(di, last_seen(row.centre, column) + 1)));
  hn::Store(hn::IfThenElse(seen, hn::Div(energy, sum), infinite_energy), df, out);
}

/// Columns whose whole window has a counterpart at every disparity below `end_d`.
struct ColumnRange {
  int first, end;
};
HWY_INLINE ColumnRange whole_windows(const AggregationRow& row, int end_d) {
  ColumnRange range{row.first, row.end};
  for (const WindowRow& window : row.rows) {
    range.first = std::max(range.first, window.first_visible + end_d - 1 + row.radius);
    range.end = std::min(range.end, window.last_valid + 1 - row.radius);
  }
  return range;
}

/// Energies of one strip at `vectors` vectors of disparities from d on.
template <int vectors>
HWY_INLINE void aggregate_strip(const AggregationRow& row, const StepList& steps, int strip, int d, float* energies) {
  const int lanes = static_cast<int>(hn::Lanes(Floats()));
  const ColumnRange whole = whole_windows(row, std::min(d + vectors * lanes, row.disparities));
  const int end = std::min(strip + strip_columns, row.end);
  for (int column = strip; column < end; column += block_columns) {
    if (column >= whole.first && column + block_columns <= whole.end) {
      if (row.radius == 0) {
        copy_block<vectors>(row, column, d, energies);
      } else if (row.step == 1) {
        aggregate_block<vectors, 1>(row, steps, column, d, energies);
      } else {
        aggregate_block<vectors, 2>(row, steps, column, d, energies);
      }
      continue;
    }
    for (int i = column; i < std::min(column + block_columns, end); ++i) {
      for (int k = 0; k < vectors; ++k) aggregate_border(row, i, d + k * lanes, energies);
    }
  }
}

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

/// The smallest energy of each of four pixels. Behind the last disparity the energies are infinite up to a whole
/// vector.
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
struct RegularisedCosts {
  PlainEnergies plain;
  float centre[4], weight[4];
  float truncation;

  HWY_INLINE RegularisedCosts(const AggregationRow& row, const PlainEnergies& energies, int column)
      : plain(energies), truncation(row.prior.truncation) {
    float smallest[4];
    min_energies(plain, row.disparities, smallest);
    for (int p = 0; p < 4; ++p) {
      const float at = column + p < row.end ? row.prior.centre[column + p] : 0.0f;
      const bool known = at == at;
      centre[p] = known ? at : 0.0f;
      weight[p] = known ? row.prior.weight * std::min(1.0f, (smallest[p] + prior_cost_offset) / prior_full_cost) : 0.0f;
    }
  }

  HWY_INLINE Float at(int p, int d) const {
    const Floats df;
    const Float away = hn::Abs(hn::Sub(hn::ConvertTo(df, count_from(d)), hn::Set(df, centre[p])));
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

HWY_INLINE void find_winners(const AggregationRow& row, int strip, float* energies, int columns, StripWinners& found) {
  for (int column = 0; column < columns; column += 4) {
    float* of_four = energies + column * row.pitch;
    for (int p = 0; p < 4; ++p) {
      std::fill(of_four + p * row.pitch + row.disparities, of_four + (p + 1) * row.pitch, infinity);
    }
    const PlainEnergies plain{of_four, row.pitch};
    if (row.prior.centre == nullptr) {
      take_winners(plain, row.disparities, found.winner + column);
    } else {
      take_winners(RegularisedCosts(row, plain, strip + column), row.disparities, found.winner + column);
    }
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

/// Writes winners, offsets and variances of a strip: for every column −1 and NaN where nothing can match, else the
/// winner and eq. (13), NaN where the winner has no neighbour on one side. The variance is derived in
/// stereo/window.hpp.
HWY_INLINE void write_winners(const AggregationRow& row, int strip, int columns, const StripWinners& found,
                              const WinnerRow& out) {
  const Floats df;
  const Ints di;
  const hn::Rebind<std::int16_t, Ints> ds;
  const int lanes = static_cast<int>(hn::Lanes(di));
  const Float nan = hn::Set(df, std::numeric_limits<float>::quiet_NaN());
  for (int i = 0; i < columns; i += lanes) {
    const Int column = count_from(strip + i);
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
    const Float vertex = hn::IfThenElseZero(curved, hn::Div(hn::Mul(half, hn::Sub(before, after)), curvature));
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

void aggregate_and_choose(const AggregationRow& row, const AggregationScratch& scratch, const WinnerRow& out) {
  const int lanes = static_cast<int>(hn::Lanes(Floats()));
  float* energies = scratch.numbers;
  float* inverse_sums = energies + strip_columns * row.pitch;
  StepList steps{.cost = scratch.pointers, .weights = inverse_sums + strip_columns, .inverse_sums = inverse_sums};
  if (row.radius > 0) list_steps(row, steps);
  for (int strip = row.first; strip < row.end; strip += strip_columns) {
    if (row.radius > 0) gather_weights(row, strip, steps);
    int d = 0;
    for (; d + lanes < row.disparities; d += 2 * lanes) aggregate_strip<2>(row, steps, strip, d, energies);
    if (d < row.disparities) aggregate_strip<1>(row, steps, strip, d, energies);
    const int columns = std::min(strip_columns, row.end - strip);
    StripWinners found;
    find_winners(row, strip, energies, columns, found);
    write_winners(row, strip, columns, found, out);
  }
}

const char* name_of_target() {
  return hwy::TargetName(HWY_TARGET);
}

}  // namespace roadstereo::cpu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace roadstereo::cpu {

HWY_EXPORT(aggregate_and_choose);
HWY_EXPORT(name_of_target);

AggregationScratchSize aggregation_scratch(int window_rows, int taps, std::ptrdiff_t pitch) {
  const std::ptrdiff_t steps = taps + window_rows;
  return {steps, strip_columns * (pitch + 1 + steps)};
}

void aggregate_and_choose(const AggregationRow& row, const AggregationScratch& scratch, const WinnerRow& out) {
  HWY_DYNAMIC_DISPATCH(aggregate_and_choose)(row, scratch, out);
}

std::string target_name() {
  return HWY_DYNAMIC_DISPATCH(name_of_target)();
}

}  // namespace roadstereo::cpu
#endif  // HWY_ONCE
