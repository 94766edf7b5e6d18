#include "stereo/cpu/match_view.hpp"

#include <algorithm>

namespace roadstereo::cpu {
namespace {

/// out[k] = row[first + k] − mid-grey, or row[width − 1 − first − k] when mirrored; 0 outside the row.
void copy_centred(const std::int16_t* row, int width, bool mirrored, int first, int count, std::int16_t* out) {
  const int begin = std::clamp(-first, 0, count);
  const int end = std::clamp(width - first, begin, count);
  std::fill_n(out, begin, std::int16_t{0});
  std::fill(out + end, out + count, std::int16_t{0});
  if (mirrored) {
    const std::int16_t* from = row + (width - 1 - first);
    for (int k = begin; k < end; ++k) out[k] = static_cast<std::int16_t>(from[-k] - mid_grey);
  } else {
    for (int k = begin; k < end; ++k) out[k] = static_cast<std::int16_t>(row[first + k] - mid_grey);
  }
}

}  // namespace

void MatchView::copy_own(int v, int first, int count, std::int16_t* out) const {
  if (side_ == reference) {
    copy_centred(input_->reference.row(v), width(), false, first, count, out);
  } else {
    copy_centred(input_->target.row(v), width(), true, first, count, out);
  }
}

void MatchView::copy_other(int v, int first, int count, std::int16_t* out) const {
  if (side_ == reference) {
    copy_centred(input_->target.row(v), width(), true, first, count, out);
  } else {
    copy_centred(input_->reference.row(v), width(), false, first, count, out);
  }
}

}  // namespace roadstereo::cpu
