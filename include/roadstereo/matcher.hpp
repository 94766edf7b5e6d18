#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "roadstereo/image.hpp"
#include "roadstereo/search_range.hpp"

#pragma GCC visibility push(default)
namespace roadstereo {

/// Curve through the costs of the winner and its neighbours. `parabola`: eq. (13), which pulls the disparities of fine
/// texture towards whole pixels, by a third of a small depth. `gaussian`: a parabola through the logarithms of the
/// correlations, as of texture that the lens has blurred.
enum class PeakFit { parabola, gaussian };

/// Shape of the aggregation window.
enum class WindowShape { square, disc };

/// Options of section 3.2: matching cost, aggregation, winner-take-all, left–right check, sub-pixel disparity.
struct MatcherOptions {
  /// Adapt the support to the pair: larger blocks and more weight of the prior in noise, and blocks that are lower
  /// where the road is more foreshortened.
  bool adapt_support = true;
  /// Distance between the pixels that are matched, along rows and columns, 1 or 2. The pixels between them are
  /// interpolated, since neighbours share most of their window. 2 needs an `aggregation_step` of 2 (or no aggregation)
  /// and one matched view.
  int pixel_step = 2;
  int block_radius = 4;  ///< r: N⁺ is 2r + 1 pixels wide, 1 … 10; the paper's 120-connected system is 5
  /// Height of N⁺ over its width, 0.1 … 1: it has 2 · round(r · block_aspect) + 1 rows, 3 at least.
  double block_aspect = 0.5;
  int aggregation_radius = 8;  ///< radius of the bilateral window, pixels, 0 … 10; 0 switches aggregation off
  /// Height of the window over its width, 0.1 … 1: a road is foreshortened along the columns, and its damage with it.
  double aggregation_aspect = 0.5;
  int aggregation_step = 2;  ///< distance between its taps, pixels, 1 or 2: neighbours share most of their block
  WindowShape aggregation_shape = WindowShape::disc;  ///< `disc` keeps the taps within the ellipse
  double sigma_space = 6.0;                           ///< σ0 of eq. (31), pixels, 0.1 … 1000
  double sigma_colour = 20.0;                         ///< σ1 of eq. (32), 8-bit grey levels, 0.1 … 100000
  /// Standard deviation of the grey-level noise, 8-bit grey levels, 0 … 50: texture below it lowers the correlation. 0
  /// is plain NCC.
  double ncc_noise_sigma = 1.0;
  bool left_right_check = true;  ///< eq. (12)
  /// Match the target view too, with costs aggregated by its own weights, as the paper does. If false, the winners of
  /// the reference view are projected into the target view instead, where the largest disparity wins; this takes half
  /// the work.
  bool match_both_views = false;
  /// Cost of one pixel of distance from the prior, in units of the correlation, 0 … 100; 0 ignores the prior.
  double prior_weight = 0.08;
  /// Truncation of that distance, pixels, 0 … 1000: damage may lie far from the prior.
  double prior_truncation_px = 8.0;
  double lr_max_diff_px =
      1.0;  ///< largest difference of the left–right check, pixels, 0 … 1024; δr of eq. (12) is its square
  /// Standard error added to disparities that fail the check, pixels, 0 … 10: refinement keeps them where neighbours
  /// with smaller errors agree. 0 makes them invalid, as the paper does.
  double occlusion_sigma_px = 1.0;
  bool sub_pixel = true;  ///< refine the winner, by `peak_fit`
  PeakFit peak_fit = PeakFit::gaussian;
  bool reject_range_boundary = false;  ///< make winners at an end of their search range invalid

  /// Throws Error naming the first option that is out of range.
  void validate() const;
  bool operator==(const MatcherOptions&) const = default;
};

/// Views of SearchRanges; empty: every pixel searches all disparities.
struct SearchRangeViews {
  ImageView<const SearchRange> reference, target;

  bool empty() const { return reference.empty(); }
};

/// Search range of each tile of either view. After the perspective transformation the road lies near δp, so that few
/// tiles need all disparities.
struct SearchRanges {
  static constexpr int tile_columns = 192;  ///< pixels
  static constexpr int tile_rows = 96;      ///< pixels

  Image<SearchRange> reference;  ///< one per tile of the reference image, row by row
  Image<SearchRange> target;     ///< one per tile of the target image

  /// Sets the range of every tile of a width × height image to 0 … disparities − 1.
  void assign(int width, int height, int disparities);
  SearchRangeViews views() const { return {reference, target}; }
};

/// View of a DisparityPrior; empty: no prior.
struct DisparityPriorView {
  ImageView<const float> disparity;
  int factor = 1;
  ImageView<const float> low = {}, high = {};
};

/// Coarse disparity map: the prior of winner-take-all.
struct DisparityPrior {
  Image<float> disparity;  ///< of the reference view, pixels of the full size; NaN: unknown
  int factor = 1;  ///< its pixel (x, y) covers factor × factor pixels from (x·factor, y·factor) on; at least 1
  /// Disparities from low to high cost nothing; NaN: unknown. As large as `disparity`, or empty: that alone.
  Image<float> low = {}, high = {};

  DisparityPriorView view() const { return {disparity, factor, low, high}; }
};

/// One grey pair of equal size, the target already transformed. All views lie in the memory of the engine that takes
/// them: the host's, or a device's.
struct MatchInput {
  ImageView<const std::int16_t> reference;
  ImageView<const std::int16_t> target;
  /// First valid column of the target per row, 0 … width; null: all valid. The window of a block begins at the first
  /// column that is valid in all its rows.
  const int* first_column = nullptr;
  int disparities = 1;  ///< D, 1 … 1024: reference (u, v) may match target (u − d, v), 0 ≤ d < D
  SearchRangeViews ranges = {};
  DisparityPriorView prior = {};
};

/// Output of `StereoEngine::match`: (x, y) is pixel (s·x, s·y) of the reference image, s = MatcherOptions::pixel_step.
struct MatchMaps {
  Image<float> disparity;      ///< sub-pixel; NaN invalid. With occlusion_sigma_px 0 that includes pixels that fail the
                               ///< left–right check
  Image<std::int16_t> winner;  ///< winner-take-all on the reference volume; −1 where nothing can match
  /// Winner-take-all on the target volume, or the reference's winners projected; −1 likewise. All columns of the
  /// target, every s-th row.
  Image<std::int16_t> target_winner;
  Image<float> variance;  ///< variance of `disparity` from the costs alone, pixels²; infinite where undetermined
};

/// Implementation of section 3.2 of the paper. Keeps scratch memory between frames of one size. Not thread-safe;
/// distinct instances are independent.
class StereoEngine {
 public:
  virtual ~StereoEngine() = default;
  /// Fills `maps`; an engine may match every pixel whatever `pixel_step` asks for. Throws Error when sizes differ or an
  /// option is out of range.
  virtual void match(const MatchInput& input, const MatcherOptions& options, MatchMaps& maps) = 0;
};

/// Entry of the registry of engines.
struct EngineInfo {
  std::string name;                                                ///< what `--engine` takes
  std::string description;                                         ///< one line
  bool exact = false;                                              ///< the double-precision oracle
  std::function<std::unique_ptr<StereoEngine>(int threads)> make;  ///< for at most that many worker threads, at least 1
};

/// Engines of this build that can run on this machine, fastest first, then those added by register_engine. In a build
/// with `cuda`, the first call looks for a GPU, which takes time and GPU memory; the names "auto" and "cuda" do so as
/// well, but no other name. The first call after register_engine makes the list grow: references to its elements from
/// before are then invalid, those from find_engine are not.
const std::vector<EngineInfo>& engines();

/// The entry of the engine called `name`; "auto" takes the first of the registry. The reference stays valid. Throws
/// like make_engine.
const EngineInfo& find_engine(const std::string& name);

/// Adds an engine of the caller. It is selected by its name in `PipelineOptions::engine`, never by "auto". The pipeline
/// uses it like its own engines: road model, shift, refinement by the variances, roll. Not thread-safe: call it before
/// other threads use pipelines. Throws Error when the name is empty, "auto" or taken, or `make` is empty.
void register_engine(EngineInfo engine);

/// Known engine that is not in `engines()`.
struct UnavailableEngine {
  std::string name;
  std::string reason;  ///< why this build or this machine lacks it, as a sentence
};

/// Known engines that cannot be used, for example `cuda` without a GPU.
const std::vector<UnavailableEngine>& unavailable_engines();

/// Makes the engine called `name`; "auto" takes the first of the registry. `threads` 0 takes all cores.
/// Throws Error naming the engines that exist, or why the requested one cannot be used.
std::unique_ptr<StereoEngine> make_engine(const std::string& name, int threads);

/// Returns the name that "auto" stands for, or `name` itself; throws like make_engine.
std::string resolve_engine_name(const std::string& name);

}  // namespace roadstereo
#pragma GCC visibility pop
