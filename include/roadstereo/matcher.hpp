#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "roadstereo/image.hpp"

namespace roadstereo {

/// Shape of the aggregation window.
enum class WindowShape { square, disc };

struct MatcherOptions {
  int block_radius = 2;        ///< N⁺ is (2r+1)² pixels; the paper's 120-connected system is 5; 1 … 10
  int aggregation_radius = 8;  ///< radius of the bilateral window, pixels; 0 switches aggregation off; 0 … 10
  /// Height of the window over its width: a road is foreshortened along the columns, and its damage with it; 0.1 … 1.
  double aggregation_aspect = 0.5;
  int aggregation_step = 2;  ///< distance between its taps, pixels, 1 or 2: neighbours share most of their block
  WindowShape aggregation_shape = WindowShape::disc;  ///< `disc` keeps the taps within the ellipse
  double sigma_space = 6.0;                           ///< σ0 of eq. omega0, pixels
  double sigma_colour = 20.0;                         ///< σ1 of eq. omega1, 8-bit grey levels
  double ncc_noise_sigma = 1.0;  ///< grey-level noise below which texture is no evidence; 0 is plain NCC, 0 … 50
  bool left_right_check = true;  ///< eq. lrc
  /// Match the target view too, with costs aggregated by its own weights, as the paper does. False projects the
  /// reference's winners into the target view instead, where the nearest of several hides the others: half the work.
  bool match_both_views = false;
  /// Cost that a disparity pays for each pixel away from the prior, in units of the correlation; 0 ignores the prior.
  double prior_weight = 0.08;
  double prior_truncation_px = 8.0;  ///< pixels away at which it stops growing, so that damage can leave the prior
  double lr_max_diff_px = 1.0;       ///< δr of eq. lrc, pixels²
  /// Standard error added to what fails the check: refinement keeps it where better-known neighbours agree. 0 makes it
  /// invalid, as the paper does.
  double occlusion_sigma_px = 1.0;
  bool sub_pixel = true;               ///< eq. subpixel
  bool reject_range_boundary = false;  ///< a winner at the end of its range, which may be no minimum, is invalid

  void validate() const;
  bool operator==(const MatcherOptions&) const = default;
};

/// The disparities that are searched, tile by tile. Knowing the road leaves few of them: after the perspective
/// transformation the road lies near δp, and a coarse look at the pair tells where something else is.
struct SearchRanges {
  static constexpr int tile_columns = 192;  ///< pixels
  static constexpr int tile_rows = 96;      ///< pixels

  /// Disparities first ≤ d < end.
  struct Range {
    std::int16_t first = 0;
    std::int16_t end = 0;
    bool operator==(const Range&) const = default;
  };
  Image<Range> reference;  ///< one per tile of the reference image, row by row
  Image<Range> target;     ///< one per tile of the target image

  /// Whole ranges for every tile of an image.
  void assign(int width, int height, int disparities);
};

/// A coarse disparity map that winner-take-all leans on where the costs leave a choice.
struct DisparityPrior {
  Image<float> disparity;  ///< of the reference view, pixels of the full size; NaN: nothing is known
  int factor = 1;          ///< its pixel (x, y) stands for the factor × factor pixels from (x·factor, y·factor) on
};

/// One pair as matching sees it: grey, same size, the target already transformed.
struct MatchInput {
  ImageView<const std::int16_t> reference;
  ImageView<const std::int16_t> target;
  /// Per row: first valid column of the target, 0 … width; null: all valid. A block is a rectangle: it begins at the
  /// first column that all its rows see.
  const int* first_column = nullptr;
  int disparities = 1;                   ///< D, 1 … 1024: reference (u, v) may match target (u − d, v), 0 ≤ d < D
  const SearchRanges* ranges = nullptr;  ///< null: every pixel searches all D disparities
  const DisparityPrior* prior = nullptr;  ///< null: the costs alone decide
};

/// What matching leaves. Sizes are those of the reference image.
struct MatchMaps {
  Image<float> disparity;  ///< sub-pixel; NaN invalid, as what fails the left–right check with occlusion_sigma_px 0
  Image<std::int16_t> winner;  ///< winner-take-all on the reference volume; −1 where nothing can match
  /// Winner-take-all on the target volume, or the reference's winners projected, in target coordinates; −1 likewise.
  Image<std::int16_t> target_winner;
  Image<float> variance;  ///< of `disparity` from the costs alone, pixels²; infinite where they do not tell
};

/// One implementation of section 3.2 of the paper. Holds scratch memory, so that matching frames of one size
/// allocates only once. One engine must not be used by two threads at a time; two engines know nothing of each other.
class StereoEngine {
 public:
  virtual ~StereoEngine() = default;
  /// Fills `maps`. Throws Error when sizes differ or a figure is out of range.
  virtual void match(const MatchInput& input, const MatcherOptions& options, MatchMaps& maps) = 0;
};

/// An engine as the registry lists it.
struct EngineInfo {
  std::string name;         ///< what `--engine` takes
  std::string description;  ///< one line
  bool exact = false;       ///< the double-precision oracle
  std::unique_ptr<StereoEngine> (*make)(int threads);
};

/// Every engine of this build that this machine can run, best first.
const std::vector<EngineInfo>& engines();

/// An engine that is known, but not in `engines()`.
struct UnavailableEngine {
  std::string name;
  std::string reason;  ///< why this build or this machine has it not, as a sentence
};

/// Every known engine that cannot be used, for example `cuda` without a GPU.
const std::vector<UnavailableEngine>& unavailable_engines();

/// Makes the engine called `name`; "auto" takes the first of the registry. `threads` 0 takes all cores.
/// Throws Error naming the engines that exist, or why the one that was asked for cannot be used.
std::unique_ptr<StereoEngine> make_engine(const std::string& name, int threads);

/// The name that "auto" stands for, or `name` itself; throws like make_engine.
std::string resolve_engine_name(const std::string& name);

}  // namespace roadstereo
