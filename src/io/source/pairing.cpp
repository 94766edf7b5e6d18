#include "io/source/pairing.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <sstream>

#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// Returns the digits from `at` on without leading zeros; advances `at`.
std::string number_at(const std::string& text, std::size_t& at) {
  const std::size_t first = at;
  while (at < text.size() && is_digit(text[at])) ++at;
  const std::size_t significant = text.find_first_not_of('0', first);
  if (significant >= at) return {};
  return text.substr(significant, at - significant);
}

ImagePair whole_pair(const ViewFile& left, const ViewFile& right) {
  return {left.stem, left.path, right.path, left.time_s.value_or(std::numeric_limits<double>::quiet_NaN()), {}};
}

enum class Side { left, right };

ImagePair unpaired(const ViewFile& view, Side side) {
  const bool left = side == Side::left;
  ImagePair pair;
  pair.name = view.stem;
  (left ? pair.left : pair.right) = view.path;
  pair.time_s = view.time_s.value_or(pair.time_s);
  pair.error = view.path + (left ? " has no right image" : " has no left image");
  return pair;
}

std::vector<ImagePair> pair_by_key(const std::vector<ViewFile>& left, const std::vector<ViewFile>& right) {
  std::vector<ImagePair> pairs;
  auto l = left.begin();
  auto r = right.begin();
  while (l != left.end() || r != right.end()) {
    if (r == right.end() || (l != left.end() && natural_less(l->key, r->key))) {
      pairs.push_back(unpaired(*l++, Side::left));
    } else if (l == left.end() || natural_less(r->key, l->key)) {
      pairs.push_back(unpaired(*r++, Side::right));
    } else {
      pairs.push_back(whole_pair(*l++, *r++));
    }
  }
  return pairs;
}

/// Whether the image after `view` is nearer in time.
bool next_is_nearer(std::vector<ViewFile>::const_iterator view, std::vector<ViewFile>::const_iterator end,
                    double time) {
  const auto after = std::next(view);
  return after != end && std::abs(*after->time_s - time) < std::abs(*view->time_s - time);
}

std::string apart_text(double difference_s, double limit_s) {
  const double difference_ms = std::round(1e5 * std::abs(difference_s)) / 100;  // resolution of seconds since 1970
  std::ostringstream text;
  text << "the views are " << difference_ms << " ms apart; the limit is " << 1e3 * limit_s << " ms";
  return text.str();
}

std::vector<ImagePair> pair_by_time(const std::vector<ViewFile>& left, const std::vector<ViewFile>& right,
                                    double limit_s) {
  std::vector<ImagePair> pairs;
  auto l = left.begin();
  auto r = right.begin();
  while (l != left.end() && r != right.end()) {
    const double difference = *l->time_s - *r->time_s;
    if (difference < 0 && next_is_nearer(l, left.end(), *r->time_s)) {
      pairs.push_back(unpaired(*l++, Side::left));
    } else if (difference > 0 && next_is_nearer(r, right.end(), *l->time_s)) {
      pairs.push_back(unpaired(*r++, Side::right));
    } else {
      pairs.push_back(whole_pair(*l, *r));
      if (std::abs(difference) > limit_s) pairs.back().error = apart_text(difference, limit_s);
      ++l;
      ++r;
    }
  }
  for (; l != left.end(); ++l) pairs.push_back(unpaired(*l, Side::left));
  for (; r != right.end(); ++r) pairs.push_back(unpaired(*r, Side::right));
  return pairs;
}

}  // namespace

bool natural_less(const std::string& one, const std::string& other) {
  std::size_t i = 0;
  std::size_t j = 0;
  while (i < one.size() && j < other.size()) {
    if (is_digit(one[i]) && is_digit(other[j])) {
      const std::string a = number_at(one, i);
      const std::string b = number_at(other, j);
      if (a.size() != b.size()) return a.size() < b.size();
      if (a != b) return a < b;
    } else {
      if (one[i] != other[j]) return one[i] < other[j];
      ++i;
      ++j;
    }
  }
  return one.size() - i < other.size() - j;
}

bool named_by_time(const std::vector<ViewFile>& views) {
  return std::all_of(views.begin(), views.end(), [](const ViewFile& view) { return view.time_s.has_value(); });
}

std::vector<ImagePair> pair_views(std::vector<ViewFile> left, std::vector<ViewFile> right,
                                  double max_time_difference_s) {
  const bool by_time = named_by_time(left) && named_by_time(right);
  const auto is_before = [by_time](const ViewFile& a, const ViewFile& b) {
    return by_time ? *a.time_s < *b.time_s : natural_less(a.key, b.key);
  };
  for (std::vector<ViewFile>* views : {&left, &right}) {
    std::sort(views->begin(), views->end(), is_before);
    const auto same = std::adjacent_find(views->begin(), views->end(),
                                         [&](const auto& a, const auto& b) { return !is_before(a, b); });
    if (same == views->end()) continue;
    fail(same->path, " and ", std::next(same)->path, " are one frame by their names; there must be one image of each");
  }
  return by_time ? pair_by_time(left, right, max_time_difference_s) : pair_by_key(left, right);
}

}  // namespace roadstereo::io
