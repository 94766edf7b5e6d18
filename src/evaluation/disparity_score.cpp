#include "roadstereo/disparity_score.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "roadstereo/error.hpp"

namespace roadstereo {
namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

template <class A, class B>
void require_equal_sizes(const A& a, const B& b, const char* name) {
  if (a.width() == b.width() && a.height() == b.height()) return;
  fail("the disparity map has ", a.width(), "×", a.height(), " pixels, but the ", name, " has ", b.width(), "×",
       b.height());
}

/// Signed errors of the labelled pixels that have a disparity; counts the labelled ones.
std::vector<double> signed_errors(ImageView<const float> disparity, ImageView<const float> truth,
                                  const std::optional<ImageView<const std::uint8_t>>& mask, std::size_t& labelled) {
  std::vector<double> errors;
  for (int v = 0; v < truth.height(); ++v) {
    for (int u = 0; u < truth.width(); ++u) {
      if (!std::isfinite(truth(u, v)) || (mask && (*mask)(u, v) == 0)) continue;
      ++labelled;
      if (std::isfinite(disparity(u, v))) errors.push_back(double{disparity(u, v)} - double{truth(u, v)});
    }
  }
  return errors;
}

double median_magnitude(std::vector<double> errors) {
  for (double& error : errors) error = std::abs(error);
  const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
  std::nth_element(errors.begin(), middle, errors.end());
  if (errors.size() % 2 == 1) return *middle;
  return (*std::max_element(errors.begin(), middle) + *middle) / 2;
}

}  // namespace

double DisparityScore::density() const {
  return truth_pixels == 0 ? 0 : static_cast<double>(given_pixels) / static_cast<double>(truth_pixels);
}

DisparityScore score_disparity(ImageView<const float> disparity, ImageView<const float> truth,
                               const std::optional<ImageView<const std::uint8_t>>& mask,
                               std::span<const double> tolerances_px) {
  require_equal_sizes(disparity, truth, "truth");
  if (mask) require_equal_sizes(disparity, *mask, "mask");
  DisparityScore score;
  const std::vector<double> errors = signed_errors(disparity, truth, mask, score.truth_pixels);
  score.given_pixels = errors.size();
  const auto given = static_cast<double>(errors.size());
  const auto labelled = static_cast<double>(score.truth_pixels);
  for (const double tolerance : tolerances_px) {
    if (!(tolerance >= 0)) fail("a disparity error tolerance is ", tolerance, " px; it must not be negative");
    const auto bad = static_cast<double>(
        std::count_if(errors.begin(), errors.end(), [&](double error) { return std::abs(error) > tolerance; }));
    score.bad_share.push_back(given > 0 ? bad / given : nothing);
    score.bad_or_missing_share.push_back(labelled > 0 ? (bad + labelled - given) / labelled : nothing);
  }
  if (errors.empty()) {
    score.rms_px = score.mean_px = score.median_px = nothing;
    return score;
  }
  double sum = 0, squares = 0;
  for (const double error : errors) {
    sum += error;
    squares += error * error;
  }
  score.mean_px = sum / given;
  score.rms_px = std::sqrt(squares / given);
  score.median_px = median_magnitude(errors);
  return score;
}

}  // namespace roadstereo
