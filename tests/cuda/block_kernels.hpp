#pragma once

// Kernels of one block that do nothing but what threads do together (core/cuda): on the GPU, or emulated. Pointers are
// of device memory.

namespace roadstereo::test {

/// Writes the sums of (k + 1)·i over i < items for every k < count: 1, 2, 3, 5, 6, 9, 10 or 32 values of block_sums().
void sum_multiples(int count, unsigned threads, int items, double* sums);

/// Writes the smallest and the largest value, one a thread.
void find_extremes(const float* values, unsigned threads, float* found);

/// Rank of a selection: the share of the values that lie below; negative for the upper median.
struct Rank {
  double share = -1;
};

/// What was selected of how many; NaN does not count.
struct Selected {
  float value;
  int of;
};

/// Selects floats, at most eight for each of the threads, which hold them in registers.
void select_value(const float* values, int count, unsigned threads, Rank rank, Selected* selected);

/// Selects three ranks at once: the first two of all values, the third of those above zero.
void select_ranks_of_two_sets(const float* values, int count, unsigned threads, const Rank (&ranks)[3],
                              Selected* selected);

/// Selects whole numbers below 2²², in floats, by keys of two digits, the first of which were counted before:
/// `first_digits` are 2048 numbers.
void select_number(const float* values, int count, unsigned threads, Rank rank, const int* first_digits,
                   Selected* selected);

/// Reverses numbers within blocks of `threads`.
void reverse_in_blocks(const int* in, unsigned blocks, unsigned threads, int* out);

/// Of every lane of two warps: the sum of the warp's lane numbers from the block's first on; the votes of lanes with
/// numbers divisible by three; the smallest of floats 24.5 − number …, that of costs |number − 41| − 10⁻⁷, where lanes
/// divisible by five have none (infinity), and the largest of −3 − number.
struct WarpResults {
  int sum;
  unsigned votes;
  float least;
  float least_cost;
  int largest;
};
void reduce_warps(WarpResults* results);

}  // namespace roadstereo::test
