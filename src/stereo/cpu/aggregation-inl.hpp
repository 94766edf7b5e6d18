// Bilateral aggregation, eq. (11), of one row: a vector holds disparities of one pixel, and pairs of pixels share
// loads.

#include <hwy/highway.h>

#include <algorithm>

#include "stereo/cpu/aggregation.hpp"

#if defined(ROADSTEREO_STEREO_CPU_AGGREGATION_INL) == defined(HWY_TARGET_TOGGLE)  // once for every instruction set
#ifdef ROADSTEREO_STEREO_CPU_AGGREGATION_INL
#undef ROADSTEREO_STEREO_CPU_AGGREGATION_INL
#else
#define ROADSTEREO_STEREO_CPU_AGGREGATION_INL
#endif
#include "stereo/cpu/vector-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace roadstereo::cpu::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Neighbouring pixels that are aggregated at once: they share loads, and their sums run side by side. As many as the
/// registers hold, twice each for two vectors of disparities.
constexpr int block_columns = (HWY_TARGET <= HWY_AVX3 || HWY_ARCH_ARM_A64) ? 8 : 4;

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
HWY_INLINE int last_seen(const AggregationRow& row, const WindowRow& window, int i) {
  const int x = i * row.pixel_step;
  return x > window.last_valid ? -1 : x - window.first_visible;
}

/// The same for one vector of disparities of one pixel near the border, over the taps that have a counterpart; infinite
/// where the pixel itself has none.
HWY_INLINE void aggregate_border(const AggregationRow& row, int column, int d, float* energies) {
  const Floats df;
  const Ints di;
  const int lanes = static_cast<int>(hn::Lanes(df));
  const Float infinite_energy = hn::Set(df, infinity);
  float* out = energies + (column - row.first) % strip_columns * row.pitch + d;
  if (d > last_seen(row, row.centre, column)) {
    hn::Store(infinite_energy, df, out);
    return;
  }
  const Int disparity = count_from(d);
  Float energy = hn::Zero(df), sum = hn::Zero(df);
  const float* const* weight = row.weights.data();
  for (const WindowRow& window : row.rows) {
    for (int k = -window.half; k <= window.half; ++k, ++weight) {
      const int i = column + k * row.step;
      const int last = last_seen(row, window, i);
      if (last < d) continue;
      Float w = hn::Set(df, (*weight)[column]);
      if (last < d + lanes - 1) {
        w = hn::IfThenElseZero(hn::RebindMask(df, hn::Lt(disparity, hn::Set(di, last + 1))), w);
      }
      energy = hn::MulAdd(w, hn::Load(df, window.costs + i * row.pitch + d), energy);
      sum = hn::Add(sum, w);
    }
  }
  const auto seen = hn::RebindMask(df, hn::Lt(disparity, hn::Set(di, last_seen(row, row.centre, column) + 1)));
  hn::Store(hn::IfThenElse(seen, hn::Div(energy, sum), infinite_energy), df, out);
}

/// a / b rounded down, for b > 0; −floor_divide(−a, b) is rounded up.
HWY_INLINE int floor_divide(int a, int b) {
  return a / b - (a % b < 0 ? 1 : 0);
}

/// Columns whose whole window has a counterpart at every disparity below `end_d`.
struct ColumnRange {
  int first, end;
};
HWY_INLINE ColumnRange whole_windows(const AggregationRow& row, int end_d) {
  ColumnRange range{row.first, row.end};
  for (const WindowRow& window : row.rows) {
    const int first_seen = -floor_divide(1 - window.first_visible - end_d, row.pixel_step);
    range.first = std::max(range.first, first_seen + row.radius);
    range.end = std::min(range.end, floor_divide(window.last_valid, row.pixel_step) + 1 - row.radius);
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

}  // namespace roadstereo::cpu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
