#include <algorithm>
#include <cmath>

#include "roadstereo/damage.hpp"

namespace roadstereo {

double DamageEvidence::confidence() const {
  return 1;
}

}  // namespace roadstereo
