#include "damage/connected_components.hpp"

#include <algorithm>
#include <cstring>

namespace roadstereo {
namespace {

/// First cell from `i` on that is 0; `width` if there is none.
int next_zero(const std::uint8_t* row, int i, int width) {
  const void* found = i < width ? std::memchr(row + i, 0, static_cast<std::size_t>(width - i)) : nullptr;
  return found == nullptr ? width : static_cast<int>(static_cast<const std::uint8_t*>(found) - row);
}

/// Runs of a mask, row by row, in a union–find forest. The root of a component is its first run.
class RunForest {
 public:
  RunForest(const Image<std::uint8_t>& mask, ConnectedComponents::Foreground foreground) {
    const bool nonzero = foreground == ConnectedComponents::Foreground::nonzero;
    std::size_t above = 0;
    for (int j = 0; j < mask.height(); ++j) {
      const std::size_t here = runs.size();
      add_row(mask.row(j), j, mask.width(), nonzero);
      unite_rows(above, here);
      above = here;
    }
    // Parents precede their children, so that one pass compresses all paths.
    for (std::size_t k = 0; k < runs.size(); ++k) parent[k] = parent[parent[k]];
  }

  std::vector<CellRun> runs;
  std::vector<std::uint32_t> parent;  ///< of each run; after construction the root of its component

 private:
  void add_row(const std::uint8_t* row, int j, int width, bool nonzero) {
    for (int i = nonzero ? next_nonzero(row, 0, width) : next_zero(row, 0, width); i < width;) {
      const int end = nonzero ? next_zero(row, i, width) : next_nonzero(row, i, width);
      parent.push_back(static_cast<std::uint32_t>(runs.size()));
      runs.push_back({j, i, end - 1});
      i = nonzero ? next_nonzero(row, end, width) : next_zero(row, end, width);
    }
  }

  /// Unite the runs from `here` on with the overlapping runs of the row above, which begin at `above`.
  void unite_rows(std::size_t above, std::size_t here) {
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

  std::uint32_t find_root(std::size_t run) {
    auto k = static_cast<std::uint32_t>(run);
    while (parent[k] != k) k = parent[k] = parent[parent[k]];
    return k;
  }

  void unite(std::size_t one, std::size_t other) {
    const std::uint32_t a = find_root(one);
    const std::uint32_t b = find_root(other);
    parent[std::max(a, b)] = std::min(a, b);
  }
};

}  // namespace

int next_nonzero(const std::uint8_t* row, int i, int width) {
  std::uint64_t eight = 0;
  for (; i + 8 <= width; i += 8) {
    std::memcpy(&eight, row + i, sizeof eight);
    if (eight != 0) break;
  }
  while (i < width && row[i] == 0) ++i;
  return i;
}

ConnectedComponents::ConnectedComponents(const Image<std::uint8_t>& mask, Foreground foreground) {
  const RunForest forest(mask, foreground);
  const std::size_t count = forest.runs.size();
  std::vector<std::uint32_t> label(count);  // component of each run
  std::vector<std::size_t> run_count;       // of each component
  for (std::size_t k = 0; k < count; ++k) {
    const std::uint32_t root = forest.parent[k];
    label[k] = root == k ? static_cast<std::uint32_t>(run_count.size()) : label[root];
    if (root == k) run_count.push_back(0);
    ++run_count[label[k]];
  }
  runs_.resize(count);
  components_.resize(run_count.size());
  std::vector<CellRun*> next(run_count.size());
  CellRun* begin = runs_.data();
  for (std::size_t c = 0; c < run_count.size(); ++c) {
    components_[c].runs = {begin, run_count[c]};
    next[c] = begin;
    begin += run_count[c];
  }
  for (std::size_t k = 0; k < count; ++k) {
    const CellRun& run = forest.runs[k];
    ConnectedComponent& component = components_[label[k]];
    *next[label[k]]++ = run;
    component.size += static_cast<std::size_t>(run.last - run.first + 1);
    component.box.add_run(run.row, run.first, run.last);
  }
  for (ConnectedComponent& component : components_) {
    const CellBox& box = component.box;
    component.touches_border = box.first_column == 0 || box.first_row == 0 || box.last_column == mask.width() - 1 ||
                               box.last_row == mask.height() - 1;
  }
}

void fill_component(const ConnectedComponent& component, std::uint8_t value, Image<std::uint8_t>& mask) {
  for (const CellRun& run : component.runs) {
    std::fill(mask.row(run.row) + run.first, mask.row(run.row) + run.last + 1, value);
  }
}

void fill_holes(Image<std::uint8_t>& mask, std::size_t max_cells) {
  for (const ConnectedComponent& hole : ConnectedComponents(mask, ConnectedComponents::Foreground::zero)) {
    if (!hole.touches_border && hole.size <= max_cells) fill_component(hole, 255, mask);
  }
}

}  // namespace roadstereo
