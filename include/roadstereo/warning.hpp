// Codes of warnings: stable words for programs, before the sentence for people.
#pragma once

#include <algorithm>
#include <string_view>

#pragma GCC visibility push(default)
namespace roadstereo {

/// Returns the code of a warning, the word before its first colon; empty if it has none. The codes are
///   no-road          no road was found: neither roll nor metric values nor damage
///   weak-road        there is little evidence for the road that was found
///   road-anew        the last frame's road did not fit, or not the expected pose: the road was searched again
///   tilted-road      the plane through the disparities is too steep for a road: as no-road
///   unexpected-pose  height or pitch are not what was expected
///   negative-disparities  what is far has a negative disparity by the calibration, and is not searched
///   rows-disagree    the rows of the pair are shifted: it is not rectified
///   rows-unknown     the row alignment could not be measured: too few points, or they contradict each other
///   few-disparities  too few pixels have a disparity, or only some on one line of the image
///   calibration-size the calibration names no image size, and seems to be that of other pictures
///   static-mask      a part of the picture never moves and is ignored from this frame on
///   no-damage        damage could not be searched
///   search-end       the floor of a damage lies where the searched disparities end
///   values-lost      a file cannot hold all values
/// and those of `HealthFinding`.
constexpr std::string_view warning_code(std::string_view warning) {
  const std::string_view word = warning.substr(0, std::min(warning.find(": "), warning.size()));
  const auto allowed = [](char letter) { return (letter >= 'a' && letter <= 'z') || letter == '-'; };
  return word.size() < warning.size() && std::all_of(word.begin(), word.end(), allowed) ? word : std::string_view();
}

}  // namespace roadstereo
#pragma GCC visibility pop
