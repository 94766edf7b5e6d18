#include "evaluate/damage_roads.hpp"

#include <cmath>

#include "evaluate/kitti_frames.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::cli {
namespace {

RoadResult score_frame(const KittiFiles& files, const DamageMethod& method) {
  const LabelledFrame frame = read_kitti_frame(files);
  if (!frame.road) fail(files.left, ": the frame has no road mask");
  const DamageMap map = find_damage_of(method, frame.pair, files.name).map;
  RoadResult result;
  result.method = method.name;
  result.frame = files.name;
  for (int v = 0; v < map.road.height(); ++v) {
    for (int u = 0; u < map.road.width(); ++u) {
      if (std::isnan(frame.truth(u, v))) continue;
      result.road.add(map.road(u, v) != 0, (*frame.road)(u, v) != 0);
    }
  }
  for (const Damage& damage : map.damages) {
    (damage.kind == DamageKind::depression ? result.depressions : result.protrusions) += 1;
  }
  result.regions = found_regions(files.name, map, [](int, int) { return false; });
  return result;
}

}  // namespace

std::vector<RoadResult> score_intact_roads(const std::string& folder, const std::vector<DamageMethod>& methods) {
  std::vector<RoadResult> results;
  const std::vector<KittiFiles> frames = find_kitti_frames(folder, "");
  for (const DamageMethod& method : methods) {
    for (const KittiFiles& files : frames) results.push_back(score_frame(files, method));
  }
  return results;
}

Table road_table(const std::vector<RoadResult>& results) {
  Table table{"Road region, and false damage on intact road",
              {{"method", "method"},
               {"frame", "frame"},
               {"IoU", "iou"},
               {"precision", "precision"},
               {"recall", "recall"},
               {"depressions", "false_depressions"},
               {"protrusions", "false_protrusions"}},
              {}};
  std::vector<double> means(5, 0);
  double count = 0;
  for (std::size_t i = 0; i < results.size(); ++i) {
    const RoadResult& one = results[i];
    const std::vector<double> values{one.road.iou(), one.road.precision(), one.road.recall(),
                                     static_cast<double>(one.depressions), static_cast<double>(one.protrusions)};
    std::vector<Cell> row{Cell(one.method), Cell(one.frame)};
    for (std::size_t k = 0; k < values.size(); ++k) {
      row.emplace_back(values[k], k < 3 ? 3 : 0);
      means[k] += values[k];
    }
    table.rows.push_back(std::move(row));
    count += 1;
    if (i + 1 < results.size() && results[i + 1].method == one.method) continue;
    std::vector<Cell> mean_row{Cell(one.method), Cell("mean")};
    for (const double sum : means) mean_row.emplace_back(sum / count, 3);
    table.rows.push_back(std::move(mean_row));
    means.assign(means.size(), 0);
    count = 0;
  }
  return table;
}

}  // namespace roadstereo::cli
