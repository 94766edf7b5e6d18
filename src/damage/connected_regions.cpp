#include "damage/connected_regions.hpp"

#include <algorithm>
#include <cstring>

namespace roadstereo {
namespace {

/// The first cell from `i` on that is not 0.
int next_set(const std::uint8_t* row, int i, int width) {
  std::uint64_t eight = 0;
  for (; i + 8 <= width; i += 8) {
    std::memcpy(&eight, row + i, sizeof eight);
    if (eight != 0) break;
  }
  while (i < width && row[i] == 0) ++i;
  return i;
}

/// The first cell from `i` on that is 0.
int next_unset(const std::uint8_t* row, int i, int width) {
  const void* found = i < width ? std::memchr(row + i, 0, static_cast<std::size_t>(width - i)) : nullptr;
  return found == nullptr ? width : static_cast<int>(static_cast<const std::uint8_t*>(found) - row);
}

/// The runs of a mask, row by row, and what hangs together of them: every run points to an earlier one of its region,
/// or to itself.
class LinkedRuns {
 public:
  LinkedRuns(const Image<std::uint8_t>& mask, ConnectedRegions::Of which) {
    const bool set = which == ConnectedRegions::Of::set;
    std::size_t above = 0;
    for (int j = 0; j < mask.height(); ++j) {
      const std::size_t here = runs.size();
      add_row(mask.row(j), j, mask.width(), set);
      link(above, here);
      above = here;
    }
    // Earlier runs know their region by the time that later ones ask them.
    for (std::size_t k = 0; k < runs.size(); ++k) earlier[k] = earlier[earlier[k]];
  }

  std::vector<CellRun> runs;
  std::vector<std::uint32_t> earlier;  ///< in the end, the first run of the region

 private:
  void add_row(const std::uint8_t* row, int j, int width, bool set) {
    for (int i = set ? next_set(row, 0, width) : next_unset(row, 0, width); i < width;) {
      const int end = set ? next_unset(row, i, width) : next_set(row, i, width);
      earlier.push_back(static_cast<std::uint32_t>(runs.size()));
      runs.push_back({j, i, end - 1});
      i = set ? next_set(row, end, width) : next_unset(row, end, width);
    }
  }

  /// Links the runs from `here` on with those of the row above that lie beside them.
  void link(std::size_t above, std::size_t here) {
    const std::size_t end_above = here;
    for (std::size_t below = here; below < runs.size() && above < end_above;) {
      if (runs[above].first <= runs[below].last && runs[below].first <= runs[above].last) unite(above, below);
      if (runs[above].last < runs[below].last) {
        ++above;
      } else {
        ++below;
      }
    }
  }

  std::uint32_t first_of(std::size_t run) {
    auto k = static_cast<std::uint32_t>(run);
    while (earlier[k] != k) k = earlier[k] = earlier[earlier[k]];
    return k;
  }

  void unite(std::size_t one, std::size_t other) {
    const std::uint32_t a = first_of(one);
    const std::uint32_t b = first_of(other);
    earlier[std::max(a, b)] = std::min(a, b);
  }
};

}  // namespace

ConnectedRegions::ConnectedRegions(const Image<std::uint8_t>& mask, Of which) {
  const LinkedRuns linked(mask, which);
  const std::size_t count = linked.runs.size();
  std::vector<std::uint32_t> region(count);  // of each run
  std::vector<std::size_t> runs_in;          // of each region
  for (std::size_t k = 0; k < count; ++k) {
    const std::uint32_t first = linked.earlier[k];
    region[k] = first == k ? static_cast<std::uint32_t>(runs_in.size()) : region[first];
    if (first == k) runs_in.push_back(0);
    ++runs_in[region[k]];
  }
  runs_.resize(count);
  regions_.resize(runs_in.size());
  std::vector<CellRun*> next(runs_in.size());
  CellRun* place = runs_.data();
  for (std::size_t r = 0; r < runs_in.size(); ++r) {
    regions_[r].runs = {place, runs_in[r]};
    next[r] = place;
    place += runs_in[r];
  }
  for (std::size_t k = 0; k < count; ++k) {
    const CellRun& run = linked.runs[k];
    *next[region[k]]++ = run;
    regions_[region[k]].size += static_cast<std::size_t>(run.last - run.first + 1);
    regions_[region[k]].box.add_run(run.row, run.first, run.last);
  }
  for (ConnectedRegion& part : regions_) {
    part.touches_border = part.box.first_column == 0 || part.box.first_row == 0 ||
                          part.box.last_column == mask.width() - 1 || part.box.last_row == mask.height() - 1;
  }
}

void paint(const ConnectedRegion& region, std::uint8_t value, Image<std::uint8_t>& mask) {
  for (const CellRun& run : region.runs) {
    std::fill(mask.row(run.row) + run.first, mask.row(run.row) + run.last + 1, value);
  }
}

void fill_enclosed(Image<std::uint8_t>& mask, std::size_t most_cells) {
  for (const ConnectedRegion& gap : ConnectedRegions(mask, ConnectedRegions::Of::unset)) {
    if (!gap.touches_border && gap.size <= most_cells) paint(gap, 255, mask);
  }
}

}  // namespace roadstereo
