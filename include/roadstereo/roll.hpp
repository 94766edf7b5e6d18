#pragma once

#include <optional>
#include <string>

#include "roadstereo/image.hpp"
#include "roadstereo/road_model.hpp"

#pragma GCC visibility push(default)
namespace roadstereo {

/// Minimiser of the energy E_t min(ψ), eq. (23).
enum class RollSolver {
  gradient_descent,  ///< the paper's, with adaptive learning rate (eqs. (25) and (28))
  closed_form,       ///< the least-squares plane, which is the same minimum
  robust             ///< IRLS with Tukey's biweight: potholes, kerbs and vehicles are outliers
};

/// Options of section 3.3.
struct RollOptions {
  RollSolver solver = RollSolver::robust;
  double initial_lambda = 10.0;  ///< λ(0) of the normalised energy, above 0, at most 1e6; see docs/method.md
  double roll_threshold_rad = 1.7453292519943296e-6;  ///< δψ = π / 1.8e6, 1e-12 … 0.1
  int max_iterations = 200;                           ///< of the descent or of the robust reweighting, 1 … 100000
  double delta_t_px = -1;                             ///< δt of eq. (29), pixels, at most 10000; negative derives it
  double max_roll_stderr_rad = 0.05;                  ///< largest standard error of an observable ψ, above 0
  double min_gradient_px = 1.0;  ///< smallest change of the road's disparity over the image for an observable ψ,
                                 ///< pixels, at least 0

  /// Throws Error naming the first option that is out of range.
  void validate() const;
};

/// Roll angle and projection model of the road: d = α0 + α1·y(ψ), y(ψ) = v cos ψ − u sin ψ (eqs. (19) and (20)).
struct RollEstimate {
  double roll_rad = 0;           ///< ψ in (−π/2, π/2]
  double roll_stderr_rad = 0;    ///< its standard error, from the residuals of image cells, and the road's camber
  bool roll_observable = false;  ///< false when the camera looks straight down: d hardly changes over the image
  double alpha0 = 0;             ///< pixels
  double alpha1 = 0;             ///< pixels per pixel
  DisparityPlane plane;          ///< the same model as a plane: a1 = α1 cos ψ, a2 = −α1 sin ψ
  int iterations = 0;            ///< steps that the solver took
  std::size_t pixels = 0;        ///< disparities used: all of them, or a regular sample by the robust solver
  double residual_px = 0;  ///< standard deviation of the disparities around the model, pixels (robust: of inliers)
};

/// Minimises eq. (23) over the valid disparities, only over those where `region` (W×H, or empty: all) is not 0.
/// `initial_roll_rad`, the last frame's ψ, starts the descent; `prior`, the road model from before matching, starts the
/// robust solver. Throws Error when fewer than 16 disparities are valid or all lie on one line of the image, when
/// `region` has another size, and when an option is out of range.
RollEstimate estimate_roll(ImageView<const float> disparity, ImageView<const std::uint8_t> region,
                           const std::optional<DisparityPlane>& prior, double initial_roll_rad,
                           const RollOptions& options, int threads = 0);

/// Transforms ℓ to ℓ', eq. (29): the intact road lies at δt; NaN invalid. Returns δt, pixels: `options.delta_t_px`, or
/// the smallest whole number, at least `min_delta_t`, that makes every value positive. Throws Error when the map is
/// empty and when an option is out of range.
double transform_disparity(ImageView<const float> disparity, const RollEstimate& geometry, double min_delta_t,
                           const RollOptions& options, int threads, Image<float>& transformed);

/// Standard deviations of the transformed disparities, eq. (37).
struct RoadResiduals {
  double sigma_road_px = 0;  ///< σ_d over the road: |ℓ' − δt| ≤ max(3·robust σ, 1 px)
  double sigma_all_px = 0;   ///< σ_d over every valid pixel
  double road_share = 0;     ///< share of the valid pixels that count as road
};
/// Measures the residuals of ℓ' around δt.
RoadResiduals measure_residuals(ImageView<const float> transformed, double delta_t, int threads = 0);

}  // namespace roadstereo
#pragma GCC visibility pop
