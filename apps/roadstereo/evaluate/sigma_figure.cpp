#include "evaluate/sigma_figure.hpp"

#include <algorithm>
#include <limits>

#include "roadstereo/io/picture_sheet.hpp"
#include "roadstereo/io/plot.hpp"

namespace roadstereo::cli {
namespace {

constexpr double percent = 100;
constexpr int panel_width = 640;

io::Curve bin_curve(const std::string& name, const std::vector<SigmaBin>& bins, double SigmaBin::*figure,
                    double factor) {
  io::Curve curve{name, {}, {}, true, true};
  for (const SigmaBin& bin : bins) {
    curve.x.push_back(bin.sigma_px);
    curve.y.push_back(factor * bin.*figure);
  }
  return curve;
}

/// Where predicted and actual are equal, over the σ of both.
io::Curve diagonal(const std::vector<SigmaBin>& visible, const std::vector<SigmaBin>& damage) {
  double lowest = std::numeric_limits<double>::infinity(), highest = 0;
  for (const auto* bins : {&visible, &damage}) {
    for (const SigmaBin& bin : *bins) {
      lowest = std::min(lowest, bin.sigma_px);
      highest = std::max(highest, bin.sigma_px);
    }
  }
  return {"actual = predicted", {lowest, highest}, {lowest, highest}, true, false, true};
}

io::Panel size_panel(const std::vector<SigmaBin>& visible, const std::vector<SigmaBin>& damage) {
  io::Panel panel{"Standard errors by tenths: what 68.3 % of the errors stay below",
                  "predicted standard error, px",
                  "actual error, px",
                  {},
                  true,
                  true};
  panel.curves = {bin_curve("both cameras see it", visible, &SigmaBin::p68_px, 1),
                  bin_curve("damage", damage, &SigmaBin::p68_px, 1), diagonal(visible, damage)};
  return panel;
}

io::Panel share_panel(const std::vector<SigmaBin>& visible, const std::vector<SigmaBin>& damage) {
  io::Panel panel{"Errors within two standard errors", "predicted standard error, px", "share, %", {}, true, false};
  panel.curves = {bin_curve("both cameras see it", visible, &SigmaBin::within_2, percent),
                  bin_curve("damage", damage, &SigmaBin::within_2, percent)};
  panel.horizontal_lines = {percent * min_within_2, percent * max_within_2};
  panel.y_highest = percent;
  double lowest = percent * min_within_2;
  for (const io::Curve& curve : panel.curves) {
    for (const double share : curve.y) lowest = std::min(lowest, share);
  }
  constexpr double margin = 5;
  panel.y_lowest = std::max(0.0, lowest - margin);
  return panel;
}

Frame group_bars(const std::vector<SigmaGroup>& groups) {
  io::BarGroups bars{
      "Errors within two standard errors, group by group", "share, %", {}, {"both cameras see it", "damage"}, {{}, {}}};
  for (const SigmaGroup& group : groups) {
    bars.groups.push_back(group.name);
    bars.values[0].push_back(percent * group.visible.within_2);
    bars.values[1].push_back(percent * group.damage.within_2);
  }
  bars.horizontal_lines = {percent * min_within_2, percent * max_within_2};
  return io::draw_bars(bars, 2 * panel_width);
}

}  // namespace

Frame sigma_figure(const std::vector<SigmaBin>& visible, const std::vector<SigmaBin>& damage,
                   const std::vector<SigmaGroup>& groups) {
  const Frame curves = io::draw_plot({size_panel(visible, damage), share_panel(visible, damage)}, panel_width);
  return io::collage({{curves}, {group_bars(groups)}});
}

}  // namespace roadstereo::cli
