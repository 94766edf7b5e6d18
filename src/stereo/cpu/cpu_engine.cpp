#include "stereo/cpu/cpu_engine.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/parallel.hpp"
#include "stereo/cpu/cost_rows.hpp"
#include "stereo/cpu/rows.hpp"
#include "stereo/window.hpp"

namespace roadstereo {
namespace {

using cpu::AggregationRow;

/// The taps of the aggregation window with the logarithm of their spatial weight (eq. omega0).
struct Aggregation {
  int radius = 0;
  std::vector<Tap> taps;
  std::vector<float> tap_log2;
  float colour_log2 = 0;

  explicit Aggregation(const MatcherOptions& options)
      : radius(options.aggregation_radius), taps(window_taps(radius, options.aggregation_shape)) {
    const double sigma0 = options.sigma_space;
    const double sigma1 = options.sigma_colour * grey_scale;
    for (const Tap& tap : taps) {
      const double distance2 = tap.du * tap.du + tap.dv * tap.dv;
      tap_log2.push_back(static_cast<float>(-distance2 / (sigma0 * sigma0) * std::numbers::log2e));
    }
    colour_log2 = static_cast<float>(-std::numbers::log2e / (sigma1 * sigma1));
  }
};

/// Matches bands of rows; owns the scratch memory of one thread: a ring of cost rows, never a volume.
class BandMatcher {
 public:
  void prepare(const MatchInput& input, const MatcherOptions& options, const Aggregation& aggregation) {
    width_ = input.reference.width();
    height_ = input.reference.height();
    disparities_ = input.disparities;
    ring_ = 2 * aggregation.radius + 1;
    costs_.prepare(input, options);
    // Behind the last column the target view reads up to D columns further.
    planes_.resize(ring_ * disparities_, width_ + disparities_, cpu::row_padding);
    scratch_.resize(cpu::choose_row_scratch(aggregation.taps.size()));
  }

  /// Matches the rows [first_row, last_row), one tile of columns after the other.
  void match(int first_row, int last_row, const MatcherOptions& options, const Aggregation& aggregation,
             MatchMaps& maps) {
    const int tile = tile_width(aggregation.radius);
    for (int begin = 0; begin < width_; begin += tile) {
      match_tile(first_row, last_row, begin, std::min(begin + tile, width_), aggregation, maps);
    }
    for (int v = first_row; v < last_row; ++v) finish_row(v, options, maps);
  }

 private:
  /// Columns that are matched together, so that their ring of costs stays in the cache of a core. The target view needs
  /// the costs of D columns more, so very many disparities are not worth cutting for.
  int tile_width(int radius) const {
    constexpr int cache_bytes = 800 * 1024;
    const int bytes_per_column = ring_ * disparities_ * static_cast<int>(sizeof(float));
    const int columns = cache_bytes / bytes_per_column - 2 * radius - disparities_;
    if (columns < std::max(cpu::column_grid, disparities_ / 2) || columns >= width_) return width_;
    return columns / cpu::column_grid * cpu::column_grid;
  }

  void match_tile(int first_row, int last_row, int begin, int end, const Aggregation& aggregation, MatchMaps& maps) {
    int next = std::max(0, first_row - aggregation.radius);
    costs_.start(next, std::max(0, begin - aggregation.radius),
                 std::min(width_, end + aggregation.radius + disparities_ - 1));
    for (int v = first_row; v < last_row; ++v) {
      for (; next <= std::min(height_ - 1, v + aggregation.radius); ++next) {
        costs_.compute(next, planes_.row((next % ring_) * disparities_), planes_.pitch());
      }
      // The sub-pixel offset waits in the disparity map until the whole row is known.
      choose(v, 0, begin, end, aggregation, {maps.winner.row(v), maps.disparity.row(v)});
      choose(v, 1, begin, end, aggregation, {maps.target_winner.row(v), nullptr});
    }
  }

  const std::int16_t* grey_row(int v, int shift) const {
    return shift == 0 ? costs_.reference_row(v) : costs_.target_row(v);
  }

  void choose(int v, int shift, int begin, int end, const Aggregation& aggregation, const cpu::WinnerRow& winners) {
    AggregationRow row;
    row.begin = begin;
    row.end = end;
    row.width = width_;
    row.disparities = disparities_;
    row.radius = aggregation.radius;
    row.plane = planes_.pitch();
    row.shift = shift;
    row.colour_log2 = aggregation.colour_log2;
    row.grey = grey_row(v, shift);
    row.first_column = costs_.first_column(v);
    taps_.clear();
    for (std::size_t i = 0; i < aggregation.taps.size(); ++i) {
      const Tap& tap = aggregation.taps[i];
      const int q = v + tap.dv;
      if (q < 0 || q >= height_) continue;
      taps_.push_back({planes_.row((q % ring_) * disparities_), grey_row(q, shift), tap.du, costs_.first_column(q),
                       aggregation.tap_log2[i]});
      row.common_first_column = std::max(row.common_first_column, taps_.back().first_column);
    }
    row.taps = taps_;
    choose_row(row, scratch_.data(), winners);
  }

  /// Left–right consistency (eq. lrc) and the sub-pixel disparity. The shift of the perspective transformation
  /// depends on the target pixel alone, so it cancels in the check.
  void finish_row(int v, const MatcherOptions& options, MatchMaps& maps) const {
    const std::int16_t* winner = maps.winner.row(v);
    const std::int16_t* target_winner = maps.target_winner.row(v);
    float* disparity = maps.disparity.row(v);
    for (int u = 0; u < width_; ++u) {
      const float offset = disparity[u];
      disparity[u] = std::numeric_limits<float>::quiet_NaN();
      if (winner[u] < 0) continue;
      if (options.left_right_check) {
        const double difference = winner[u] - target_winner[u - winner[u]];
        if (difference * difference > options.consistency) continue;
      }
      const bool bracketed = !std::isnan(offset);
      if (!bracketed && options.drop_range_ends) continue;
      disparity[u] = static_cast<float>(winner[u]) + (bracketed && options.sub_pixel ? offset : 0.0f);
    }
  }

  int width_ = 0;
  int height_ = 0;
  int disparities_ = 0;
  int ring_ = 1;
  cpu::CostRows costs_;
  cpu::PaddedRows<float> planes_;
  std::vector<cpu::RowTap> taps_;
  std::vector<float> scratch_;
};

class CpuEngine final : public StereoEngine {
 public:
  explicit CpuEngine(int threads) : threads_(resolve_threads(threads)), matchers_(static_cast<std::size_t>(threads_)) {}

  void match(const MatchInput& input, const MatcherOptions& options, MatchMaps& maps) override {
    validate(input);
    options.validate();
    const int width = input.reference.width();
    const int height = input.reference.height();
    maps.winner.resize(width, height);
    maps.target_winner.resize(width, height);
    maps.disparity.resize(width, height);
    const Aggregation aggregation(options);
    for (BandMatcher& matcher : matchers_) matcher.prepare(input, options, aggregation);
    // A band begins by filling its rings, so few long bands; four a thread even out their unequal speed.
    const int halo = 2 * (options.block_radius + options.aggregation_radius);
    const int rows = std::max(2 * halo, (height + 4 * threads_ - 1) / (4 * threads_));
    parallel_rows(height, rows, threads_, [&](int first, int last, int worker) {
      matchers_[static_cast<std::size_t>(worker)].match(first, last, options, aggregation, maps);
    });
  }

 private:
  int threads_;
  std::vector<BandMatcher> matchers_;
};

}  // namespace

std::unique_ptr<StereoEngine> make_cpu_engine(int threads) {
  return std::make_unique<CpuEngine>(threads);
}

std::string cpu_engine_target() {
  return cpu::target_name();
}

}  // namespace roadstereo
