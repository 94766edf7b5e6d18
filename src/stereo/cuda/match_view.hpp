#pragma once

#include <cstddef>
#include <cstdint>

#include "core/cuda/stream.hpp"
#include "roadstereo/image_view.hpp"
#include "roadstereo/search_range.hpp"
#include "stereo/cuda/block_sums.hpp"

namespace roadstereo::cuda {

/// Tap of the aggregation window: its offset from the pixel, and log2 of its weight by distance, eq. (31).
struct WindowTap {
  std::int16_t du;
  std::int16_t dv;
  float log2_space;
};

/// One view of a pair as the kernel walks over it. The kernel knows one direction only: pixel i of its own view may
/// match pixel i − d of the other. For the target view both images are therefore read mirrored, from their last
/// columns on; the planes themselves are not.
struct ViewToMatch {
  ImageView<const std::int16_t> own, other;
  ImageView<const ColumnSums> own_columns, other_columns;
  ImageView<const BlockPart> own_blocks, other_blocks;
  const int* first_column;  ///< per row: first column of the target that its whole blocks see
  bool mirrored;            ///< the own view is the target
  int disparities;
  ImageView<const SearchRange> ranges;  ///< one per tile of the own view; empty: all search all disparities
  int range_columns;                    ///< pixels of such a tile
  int range_rows;
  ImageView<const float> prior_low, prior_high;  ///< of winner-take-all; empty: none
  int prior_factor;                              ///< pixels of a pixel of the prior, across and down
};

struct ViewSettings {
  int pixel_step;                      ///< distance between the pixels that are matched, along rows and columns
  int block_radius, block_row_radius;  ///< along rows and columns
  float noise_variance;
  const WindowTap* taps;  ///< in device memory
  int tap_count;
  int window_half_width;  ///< of the taps, pixels
  int window_half_height;
  float log2_colour;        ///< −log2 e / σ1², per squared step of grey
  float effective_samples;  ///< of an energy (stereo/window.hpp)
  float peak_floor;         ///< of the offset (stereo/window.hpp)
  float prior_weight;
  float prior_truncation_px;
};

/// Output for the matched pixels of a view: winners (−1 where nothing can match), their offsets to the minimum, NaN
/// without two neighbours, and their variances.
struct ViewWinners {
  ImageView<std::int16_t> winner;
  ImageView<float> offset;  ///< empty: not written, nor the variance
  ImageView<float> variance;
};

/// Launch of the kernel: as many blocks as are resident at a time, each with memory for its energies.
struct ViewLaunch {
  int blocks;
  std::size_t energies_per_block;  ///< floats
  std::size_t shared_bytes;
  bool staged;       ///< the pixels of a tile and its halo have room in shared memory
  bool costs_apart;  ///< so have the costs beside the products, for the blocks and the window of a preset
};

/// Numbers of tiles that blocks take in turn when they have matched their first: counted from launch to launch, so that
/// nothing is cleared.
struct TileTickets {
  unsigned* drawn;   ///< in device memory
  unsigned already;  ///< by the launches before
};

/// For a device with so many multiprocessors.
ViewLaunch plan_view_launch(const ViewSettings& settings, int width, int height, int disparities, int multiprocessors);

/// Matches one view in one kernel: matching costs, eq. (8), bilateral aggregation, eqs. (11) and (30), and
/// winner-take-all. Costs lie in shared memory, energies in a slice of `energies` that stays in the cache.
/// `taps_on_host`: the settings' taps in host memory. Returns the tickets that are drawn.
unsigned match_view(const ViewToMatch& view, const ViewSettings& settings, const WindowTap* taps_on_host,
                    const ViewLaunch& plan, float* energies, const TileTickets& tickets, const ViewWinners& winners,
                    StreamView stream);

}  // namespace roadstereo::cuda
