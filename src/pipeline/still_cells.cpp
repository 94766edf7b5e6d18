#include "pipeline/still_cells.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "core/order_statistics.hpp"
#include "damage/connected_components.hpp"

namespace roadstereo {
namespace {

constexpr float rounding_variance = grey_scale * grey_scale / 12.0F;  // of 8-bit levels
constexpr std::size_t min_still_cells = 12;                           // less is no evidence
constexpr int texture_radius = 3;                                     // cells

using CellMask = Image<std::uint8_t>;

/// Structure tensor of the mean levels over a window of cells, from differences of cells `reach` to both sides, and the
/// variance of the same differences over the frames.
struct CellTexture {
  double uu = 0, uv = 0, vv = 0;
  double variance = 0;
  std::size_t cells = 0;

  /// Whether the mean keeps a texture that the variance does not explain: had it moved, it would be blurred in the
  /// direction of the motion. A line along the motion has one eigenvalue only.
  bool is_lasting(double max_ratio) const {
    constexpr double min_isotropy = 0.05;
    const double half = 0.5 * (uu + vv), spread = 0.5 * std::hypot(uu - vv, 2 * uv);
    const double least = half - spread, greatest = half + spread;
    return cells >= min_still_cells && least >= min_isotropy * greatest && variance <= max_ratio * least;
  }
};

/// Leaves out differences of cells that vary by more than `max_variance`.
CellTexture texture_around(const CellLevels& levels, int x, int y, int reach, float max_variance) {
  const Image<float>&mean = levels.mean(), &variance = levels.variance();
  CellTexture texture;
  const int last_u = std::min(mean.width() - 1 - reach, x + texture_radius);
  const int last_v = std::min(mean.height() - 1 - reach, y + texture_radius);
  for (int v = std::max(reach, y - texture_radius); v <= last_v; ++v) {
    for (int u = std::max(reach, x - texture_radius); u <= last_u; ++u) {
      const std::array around{variance(u - reach, v), variance(u + reach, v), variance(u, v - reach),
                              variance(u, v + reach)};
      if (*std::max_element(around.begin(), around.end()) > max_variance) continue;
      const double along = double{mean(u + reach, v) - mean(u - reach, v)};
      const double down = double{mean(u, v + reach) - mean(u, v - reach)};
      texture.uu += along * along;
      texture.uv += along * down;
      texture.vv += down * down;
      texture.variance += 0.5 * double{around[0] + around[1] + around[2] + around[3] + 4 * rounding_variance};
      ++texture.cells;
    }
  }
  return texture;
}

/// Cells with a lasting texture, fine or coarse, that vary by `max_variance` at most.
CellMask find_lasting_texture(const CellLevels& levels, double max_ratio, float max_variance) {
  constexpr std::array reaches{1, 2, 4};
  CellMask lasting(levels.mean().width(), levels.mean().height(), 0);
  for (int y = 0; y < lasting.height(); ++y) {
    for (int x = 0; x < lasting.width(); ++x) {
      if (levels.variance()(x, y) > max_variance) continue;
      const bool is_lasting = std::any_of(reaches.begin(), reaches.end(), [&](int reach) {
        return texture_around(levels, x, y, reach, max_variance).is_lasting(max_ratio);
      });
      lasting(x, y) = is_lasting ? 255 : 0;
    }
  }
  return lasting;
}

/// Largest variance over the frames that noise explains: the first quartile of the variances of the lasting texture,
/// since some of it moves slowly, plus the error of an estimate from that number of frames. Negative without lasting
/// texture.
float noise_limit(const CellLevels& levels, const CellMask& lasting) {
  constexpr float deviations = 5;
  std::vector<float> variances;
  for (int y = 0; y < lasting.height(); ++y) {
    for (int x = 0; x < lasting.width(); ++x) {
      if (lasting(x, y) != 0) variances.push_back(levels.variance()(x, y));
    }
  }
  if (variances.size() < min_still_cells) return -1;
  const float typical = select_rank(variances, static_cast<std::ptrdiff_t>(variances.size() / 4));
  return rounding_variance + typical * (1 + deviations * std::sqrt(2 / static_cast<float>(levels.frames())));
}

/// A part of the quiet cells, and what is beside it.
struct BesidePart {
  std::size_t still = 0, moving = 0;
};

BesidePart look_around(const ConnectedComponent& part, const CellMask& candidates, const CellMask& still) {
  BesidePart beside;
  for_each_neighbour(part, still.width(), still.height(), [&](int x, int y) {
    if (candidates(x, y) == 0) ++(still(x, y) != 0 ? beside.still : beside.moving);
  });
  return beside;
}

/// Quiet cells off sharp edges: an edge that lasts parts a bonnet from a road without texture.
CellMask find_quiet_parts(const CellLevels& levels, double max_ratio, float max_variance) {
  const Image<float>&mean = levels.mean(), &variance = levels.variance();
  CellMask quiet(mean.width(), mean.height(), 0);
  const auto column = [&](int x) { return std::clamp(x, 0, mean.width() - 1); };
  const auto row = [&](int y) { return std::clamp(y, 0, mean.height() - 1); };
  for (int y = 0; y < mean.height(); ++y) {
    for (int x = 0; x < mean.width(); ++x) {
      const double along = double{mean(column(x + 1), y) - mean(column(x - 1), y)};
      const double down = double{mean(x, row(y + 1)) - mean(x, row(y - 1))};
      const double noise = 2 * double{variance(x, y) + rounding_variance};
      const bool is_edge = max_ratio * (along * along + down * down) > noise;
      quiet(x, y) = variance(x, y) <= max_variance && !is_edge ? 255 : 0;
    }
  }
  return quiet;
}

/// Adds the parts of which at least half have a lasting texture.
void complete_parts(const CellMask& quiet, CellMask& still) {
  for (const ConnectedComponent& part : ConnectedComponents(quiet)) {
    std::size_t lasting = 0;
    for (const CellRun& run : part.runs) {
      for (int x = run.first; x <= run.last; ++x) lasting += still(x, run.row) != 0 ? 1U : 0U;
    }
    if (2 * lasting >= part.size) fill_component(part, 255, still);
  }
}

/// Adds quiet cells that still ones surround: nearly all of their neighbours are.
void fill_surrounded(const CellLevels& levels, float max_variance, CellMask& still) {
  constexpr std::size_t still_to_moving = 10;
  CellMask unknown(still.width(), still.height(), 0);
  for (int y = 0; y < still.height(); ++y) {
    for (int x = 0; x < still.width(); ++x) {
      unknown(x, y) = still(x, y) == 0 && levels.variance()(x, y) <= max_variance ? 255 : 0;
    }
  }
  for (const ConnectedComponent& part : ConnectedComponents(unknown)) {
    const BesidePart beside = look_around(part, unknown, still);
    if (beside.still > still_to_moving * beside.moving) fill_component(part, 255, still);
  }
}

/// Removes what is small or apart from the border: what is mounted on a rig reaches in from there.
void remove_loose(CellMask& still) {
  for (const ConnectedComponent& part : ConnectedComponents(still)) {
    if (part.size < min_still_cells || !part.touches_border) fill_component(part, 0, still);
  }
}

bool more_moves(const CellLevels& levels, float max_variance, const CellMask& still) {
  std::size_t moving = 0, resting = 0;
  for (int y = 0; y < still.height(); ++y) {
    for (int x = 0; x < still.width(); ++x) {
      moving += levels.variance()(x, y) > max_variance ? 1U : 0U;
      resting += still(x, y) != 0 ? 1U : 0U;
    }
  }
  return moving > resting;
}

}  // namespace

std::optional<Image<std::uint8_t>> find_still_cells(const CellLevels& levels, double max_variance_ratio) {
  const CellMask lasting = find_lasting_texture(levels, max_variance_ratio, std::numeric_limits<float>::infinity());
  const float noise = noise_limit(levels, lasting);
  // Repeated without the moving cells, so that the still area reaches up to its edge.
  CellMask still = find_lasting_texture(levels, max_variance_ratio, noise);
  complete_parts(find_quiet_parts(levels, max_variance_ratio, noise), still);
  fill_surrounded(levels, noise, still);
  if (!more_moves(levels, noise, still)) return std::nullopt;
  remove_loose(still);
  return still;
}

}  // namespace roadstereo
