#pragma once

// Vector kernel for the weights ω(p, q) of eq. (30).

namespace roadstereo::cpu {

/// weights[i] = ω0·ω1 for the pixels i in [first, end) of one row and their neighbours at `neighbour`[i]:
/// 2^(log2_space + log2_colour·(difference of the grey values)²).
void bilateral_weights(const float* centre, const float* neighbour, float log2_space, float log2_colour, int first,
                       int end, float* weights);

}  // namespace roadstereo::cpu
