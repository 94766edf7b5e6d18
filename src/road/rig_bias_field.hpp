#pragma once

#include "roadstereo/host_device.hpp"
#include "roadstereo/image_view.hpp"
#include "roadstereo/rig_bias.hpp"

namespace roadstereo {

/// A row of a RigBias: a polynomial along u.
template <class Real>
struct BiasRow {
  Real by_power[5];
  Real centre_u, scale, first_u, last_u;

  ROADSTEREO_HD Real at(Real in) const {
    const Real x = ((in < first_u ? first_u : in > last_u ? last_u : in) - centre_u) * scale;
    return by_power[0] + x * (by_power[1] + x * (by_power[2] + x * (by_power[3] + x * by_power[4])));
  }
};

/// A RigBias as kernels and host evaluate it.
template <class Real>
struct BiasPolynomial {
  Real value[15];  ///< RigBias::value_px
  Real centre_u, centre_v, scale;
  Real first_u, first_v, last_u, last_v;

  ROADSTEREO_HD BiasRow<Real> row(Real v) const {
    const Real y = ((v < first_v ? first_v : v > last_v ? last_v : v) - centre_v) * scale;
    return {{value[0] + y * (value[2] + y * (value[5] + y * (value[9] + y * value[14]))),
             value[1] + y * (value[4] + y * (value[8] + y * value[13])), value[3] + y * (value[7] + y * value[12]),
             value[6] + y * value[11], value[10]},
            centre_u,
            scale,
            first_u,
            last_u};
  }
};

template <class Real>
BiasPolynomial<Real> bias_polynomial(const RigBias& bias) {
  BiasPolynomial<Real> field{};
  for (std::size_t i = 0; i < RigBias::terms; ++i) field.value[i] = static_cast<Real>(bias.value_px[i]);
  field.centre_u = static_cast<Real>(0.5 * (bias.width - 1));
  field.centre_v = static_cast<Real>(0.5 * (bias.height - 1));
  field.scale = static_cast<Real>(2.0 / bias.width);
  field.first_u = static_cast<Real>(bias.region_px[0]);
  field.first_v = static_cast<Real>(bias.region_px[1]);
  field.last_u = static_cast<Real>(bias.region_px[2]);
  field.last_v = static_cast<Real>(bias.region_px[3]);
  return field;
}

/// Subtracts the bias from every disparity, in place.
void subtract_bias(const BiasPolynomial<float>& bias, int threads, ImageView<float> disparity);

}  // namespace roadstereo
