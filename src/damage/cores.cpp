#include "damage/cores.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "damage/outline.hpp"

namespace roadstereo {
namespace {

constexpr float max_saddle_share = 0.5F;  ///< of the depth of the floor of both basins

ConnectedComponent component_of(const std::vector<CellRun>& runs) {
  ConnectedComponent component;
  component.runs = runs;
  for (const CellRun& run : runs) {
    component.size += static_cast<std::size_t>(run.last - run.first + 1);
    component.box.add_run(run.row, run.first, run.last);
  }
  return component;
}

/// The connected parts of a core deeper than a level that are as large as a damage and have a floor deep enough;
/// none if fewer than two are as large.
std::vector<std::vector<CellRun>> basins_at(const Image<float>& depth, const ConnectedComponent& core, float level,
                                            float min_cells) {
  const CellBox& box = core.box;
  Image<std::uint8_t> deep(box.columns(), box.rows(), 0);
  for (const CellRun& run : core.runs) {
    const float* const depths = depth.row(run.row);
    std::uint8_t* const cells = deep.row(run.row - box.first_row);
    for (int i = run.first; i <= run.last; ++i) cells[i - box.first_column] = depths[i] > level ? 255 : 0;
  }
  const ConnectedComponents parts(deep);
  const auto is_large = [&](const ConnectedComponent& part) { return static_cast<float>(part.size) >= min_cells; };
  std::vector<std::vector<CellRun>> basins;
  if (std::count_if(parts.begin(), parts.end(), is_large) < 2) return basins;
  for (const ConnectedComponent& part : parts) {
    if (!is_large(part)) continue;
    std::vector<CellRun> runs;
    for (const CellRun& run : part.runs) {
      runs.push_back({run.row + box.first_row, run.first + box.first_column, run.last + box.first_column});
    }
    if (max_saddle_share * floor_depth(depth, component_of(runs)) >= level) basins.push_back(std::move(runs));
  }
  return basins;
}

}  // namespace

Cores::Cores(const Image<float>& depth, const Image<std::uint8_t>& deep, const Thresholds& thresholds)
    : components_(deep) {
  for (const ConnectedComponent& component : components_) {
    const CellRun& first = component.runs.front();
    add(depth, {component}, thresholds.min_depth(first.first, first.row), thresholds.min_cells(first.first, first.row));
  }
  std::stable_sort(cores_.begin(), cores_.end(), [](const Core& one, const Core& other) {
    if (one.is_divided != other.is_divided) return other.is_divided;
    return one.is_divided ? one.cells.size < other.cells.size : one.cells.size > other.cells.size;
  });
}

/// `min_level`: all cells of the core are about as deep, or deeper.
void Cores::add(const Image<float>& depth, const Core& core, float min_level, float min_cells) {
  constexpr int levels = 6;
  const bool can_be_two = static_cast<float>(core.cells.size) >= 2 * min_cells;
  const float max_level = can_be_two ? max_saddle_share * floor_depth(depth, core.cells) : 0;
  for (int k = 1; k <= levels && max_level > min_level; ++k) {
    const float level = min_level * std::pow(max_level / min_level, static_cast<float>(k) / levels);
    std::vector<std::vector<CellRun>> basins = basins_at(depth, core.cells, level, min_cells);
    if (basins.size() < 2) continue;
    for (std::vector<CellRun>& runs : basins) {
      basins_.push_back(std::move(runs));
      add(depth, {component_of(basins_.back()), level}, level, min_cells);
    }
    cores_.push_back({core.cells, core.saddle, true});
    return;
  }
  cores_.push_back(core);
}

}  // namespace roadstereo
