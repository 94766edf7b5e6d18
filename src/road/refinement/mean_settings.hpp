#pragma once

namespace roadstereo {

struct MeanSettings {
  float reach2 = 9;  ///< squared number of joint standard errors at which a neighbour loses its weight
  float share = 1;   ///< part of one neighbour that is independent of the others
};

}  // namespace roadstereo
