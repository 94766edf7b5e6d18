#pragma once

#include <optional>
#include <string>

#include "roadstereo/image.hpp"
#include "roadstereo/road_model.hpp"

namespace roadstereo {

/// How the energy E_t min(ψ) (eq. (23)) is minimised.
enum class RollSolver {
  gradient_descent,  ///< the paper's, with adaptive learning rate (eqs. (25), (28))
  closed_form,       ///< the least-squares plane, which is the same minimum
  robust             ///< potholes, kerbs and vehicles do not pull it
};

struct RollOptions {
  RollSolver solver = RollSolver::robust;
  double initial_lambda = 10.0;                       ///< λ(0) of the normalised energy, see docs/method.md
  double roll_threshold_rad = 1.7453292519943296e-6;  ///< δψ = π / 1.8e6
  int max_iterations = 200;                           ///< of the descent or of the robust reweighting
  double delta_t_px = -1;                             ///< δt of eq. (29); negative derives it
  double max_roll_stderr_rad = 0.05;                  ///< ψ is observable below this standard error
  double min_gradient_px = 1.0;                       ///< ... and when the road's disparity changes by more than this

  void validate() const;
};

/// Roll angle and projection model of the road: d = α0 + α1·y(ψ), y(ψ) = v cos ψ − u sin ψ (eqs. (19), (20)).
struct RollEstimate {
  double roll_rad = 0;           ///< ψ in (−π/2, π/2]
  double roll_stderr_rad = 0;    ///< its standard error, from the residuals of image cells (neighbours are correlated)
  bool roll_observable = false;  ///< false when the camera looks straight down: d hardly changes over the image
  double alpha0 = 0;             ///< pixels
  double alpha1 = 0;             ///< pixels per pixel
  DisparityPlane plane;          ///< the same model as a plane: a1 = α1 cos ψ, a2 = −α1 sin ψ
  int iterations = 0;            ///< steps that the solver took
  std::size_t pixels = 0;        ///< disparities used: all of them, or a regular sample by the robust solver
  double residual_px = 0;  ///< standard deviation of the disparities around the model, pixels (robust: of inliers)
};

/// Minimises eq. (23) over the valid disparities. `mask` (0 = leave out), when given, has the map's size.
/// `initial` is the previous frame's result: its ψ starts the descent, its plane starts the robust solver.
/// `prior`, when given, is the road model known before matching: the robust solver starts from it.
/// Throws Error when fewer than 16 disparities are valid or all lie on one line of the image.
RollEstimate estimate_roll(ImageView<const float> disparity, const std::optional<ImageView<const std::uint8_t>>& mask,
                           const std::optional<DisparityPlane>& prior, double initial_roll_rad,
                           const RollOptions& options, int threads = 0);

/// The transformed map ℓ' of eq. (29): the intact road lies at δt.
/// Returns δt: `options.delta_t_px`, or the smallest whole number that makes every value positive, at least `least`.
double transform_disparity(ImageView<const float> disparity, const RollEstimate& geometry, double min_delta_t,
                           const RollOptions& options, int threads, Image<float>& transformed);

/// Spread of the transformed disparities (eq. (37)).
struct RoadResiduals {
  double sigma_road_px = 0;  ///< σ_d over the road: |ℓ' − δt| ≤ max(3·robust σ, 1 px)
  double sigma_all_px = 0;   ///< σ_d over every valid pixel
  double road_share = 0;     ///< share of the valid pixels that count as road
};
RoadResiduals measure_residuals(ImageView<const float> transformed, double delta_t, int threads = 0);

}  // namespace roadstereo
