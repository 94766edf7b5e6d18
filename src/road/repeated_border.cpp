#include "road/repeated_border.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "roadstereo/grey_scale.hpp"

namespace roadstereo {
namespace {

constexpr int min_lines = 3;  // fewer do not fill a block

/// Rows or columns of an image, counted from a side of it.
class Lines {
 public:
  enum class Side { top, bottom, left, right };

  Lines(ImageView<const std::int16_t> grey, Side side)
      : grey_(grey),
        of_columns_(side == Side::left || side == Side::right),
        from_end_(side == Side::bottom || side == Side::right) {}

  int count() const { return of_columns_ ? grey_.width() : grey_.height(); }
  int length() const { return of_columns_ ? grey_.height() : grey_.width(); }
  /// Lines that a border may have.
  int most() const { return count() / 8; }
  int level(int line, int at) const {
    const int k = from_end_ ? count() - 1 - line : line;
    return of_columns_ ? grey_(k, at) : grey_(at, k);
  }

 private:
  ImageView<const std::int16_t> grey_;
  bool of_columns_, from_end_;
};

/// Places along a line, within its middle three quarters, where it has texture: steps of two grey levels and more.
class TexturedPlaces {
 public:
  TexturedPlaces(const Lines& lines, int line) : lines_(lines), line_(line) {
    constexpr int min_step = 2 * grey_scale;
    const int margin = std::max(1, lines.length() / 8), step = std::max(1, lines.length() / most);
    for (int at = margin; at + margin < lines.length() && count_ < most; at += step, ++looked_at_) {
      const int difference = std::abs(lines.level(line, at) - lines.level(line, at + 1));
      if (difference < min_step) continue;
      at_[static_cast<std::size_t>(count_++)] = at;
      contrast_ += difference;
    }
  }

  /// Whether there are enough: edges of a drawing are no texture.
  bool suffice() const { return count_ >= std::max(least, looked_at_ / 8); }
  /// Mean difference from another line there, relative to the steps along this one.
  double difference(int other) const {
    int sum = 0;
    for (int k = 0; k < count_; ++k) {
      const int at = at_[static_cast<std::size_t>(k)];
      sum += std::abs(lines_.level(line_, at) - lines_.level(other, at));
    }
    return static_cast<double>(sum) / contrast_;
  }

 private:
  static constexpr int most = 128, least = 16;
  const Lines& lines_;
  int line_;
  std::array<int, most> at_{};
  int count_ = 0, looked_at_ = 0, contrast_ = 0;
};

/// Smallest difference of neighbours among 16 lines from `first` on and 16 over the middle half of the picture; 0 with
/// too little texture.
double smallest_difference(const Lines& lines, int first) {
  constexpr int looked_at = 16, least = looked_at;
  double smallest = 1;
  int known = 0;
  const auto look_at = [&](int line) {
    if (line + 1 >= lines.count()) return;
    const TexturedPlaces places(lines, line);
    if (!places.suffice()) return;
    smallest = std::min(smallest, places.difference(line + 1));
    ++known;
  };
  for (int k = 0; k < looked_at; ++k) {
    look_at(first + k);
    look_at(lines.count() / 4 + k * lines.count() / (2 * looked_at));
  }
  return known < least ? 0 : smallest;
}

/// Number of lines that are replicated: they differ from the next by less than an eighth of what any others do.
int replicated_lines(const Lines& lines) {
  constexpr double alike = 0.0625, share = 0.125;
  int count = 0;
  double largest = 0;
  while (count <= lines.most()) {
    const TexturedPlaces places(lines, count);
    const double difference = places.suffice() ? places.difference(count + 1) : 1;
    if (difference > alike) break;
    largest = std::max(largest, difference);
    ++count;
  }
  if (count < min_lines || count > lines.most()) return 0;
  return largest < share * smallest_difference(lines, count + 1) ? count : 0;
}

/// The one line that repeats the outermost one, which is less than half as different as the neighbour; 0 if none
/// does, or lines apart: a pattern repeats more than once. Its neighbours may as well, where the picture was resampled.
int mirror_of_first(const Lines& lines, const TexturedPlaces& first, double neighbour) {
  double least = 0.5 * neighbour;
  int mirror = 0, begin = 0, end = 0;
  for (int line = 2; line <= 2 * lines.most(); ++line) {
    const double difference = first.difference(line);
    if (difference >= 0.5 * neighbour) continue;
    begin = begin == 0 ? line : begin;
    end = line;
    if (difference >= least) continue;
    least = difference;
    mirror = line;
  }
  constexpr int max_run = 3;
  return end - begin < max_run ? mirror : 0;
}

/// Number of lines that are the mirror image of those inside. Lines of a picture differ the more the further apart they
/// are; these differ from their mirror image by less than half of what they do from their neighbours.
int mirrored_lines(const Lines& lines) {
  constexpr double least_texture = 0.0625;
  const TexturedPlaces first(lines, 0);
  if (!first.suffice()) return 0;
  const double neighbour = first.difference(1);
  if (neighbour < least_texture) return 0;
  const int mirror = mirror_of_first(lines, first, neighbour);
  const int count = (mirror + 1) / 2;
  if (count < min_lines) return 0;
  double from_mirror = 0, from_neighbour = 0;
  int known = 0;
  for (int line = 0; line < mirror / 2; ++line) {
    const TexturedPlaces places(lines, line);
    if (!places.suffice()) continue;
    ++known;
    from_mirror += places.difference(mirror - line);
    from_neighbour += places.difference(line + 1);
  }
  if (2 * known < mirror / 2) return 0;
  return from_mirror < 0.5 * from_neighbour ? count : 0;
}

int repeated_lines(const Lines& lines) {
  if (lines.most() < min_lines) return 0;
  return std::max(replicated_lines(lines), mirrored_lines(lines));
}

}  // namespace

RepeatedBorder find_repeated_border(ImageView<const std::int16_t> grey) {
  using Side = Lines::Side;
  const auto found = [grey](Side side) { return repeated_lines(Lines(grey, side)); };
  return {found(Side::top), found(Side::bottom), found(Side::left), found(Side::right)};
}

}  // namespace roadstereo
