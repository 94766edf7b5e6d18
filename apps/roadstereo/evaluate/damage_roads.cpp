#include "evaluate/damage_roads.hpp"

#include <cmath>

#include "evaluate/kitti_frames.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/pipeline.hpp"

namespace roadstereo::cli {
namespace {

RoadResult score_frame(const KittiFiles& files, const std::string& preset_name) {
  const LabelledFrame frame = read_kitti_frame(files);
  if (!frame.road) fail(files.left, ": the frame has no road mask");
  Pipeline pipeline(preset(preset_name), frame.pair.calibration);
  pipeline.process(frame.pair.left.view(), frame.pair.right.view());
  const DamageMap map = pipeline.find_damage();
  RoadResult result;
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
  return result;
}

}  // namespace

std::vector<RoadResult> score_intact_roads(const std::string& folder, const std::string& preset_name) {
  std::vector<RoadResult> results;
  for (const KittiFiles& files : find_kitti_frames(folder, "")) results.push_back(score_frame(files, preset_name));
  return results;
}

Table road_table(const std::vector<RoadResult>& results) {
  Table table{"Road region, and false damage on intact road",
              {{"frame", "frame"},
               {"IoU", "iou"},
               {"precision", "precision"},
               {"recall", "recall"},
               {"depressions", "false_depressions"},
               {"protrusions", "false_protrusions"}},
              {}};
  const auto count = static_cast<double>(results.size());
  std::vector<double> means(5, 0);
  for (const RoadResult& one : results) {
    const std::vector<double> values{one.road.iou(), one.road.precision(), one.road.recall(),
                                     static_cast<double>(one.depressions), static_cast<double>(one.protrusions)};
    std::vector<Cell> row{Cell(one.frame)};
    for (std::size_t k = 0; k < values.size(); ++k) {
      row.emplace_back(values[k], k < 3 ? 3 : 0);
      means[k] += values[k] / count;
    }
    table.rows.push_back(std::move(row));
  }
  std::vector<Cell> row{Cell("mean")};
  for (const double mean : means) row.emplace_back(mean, 3);
  table.rows.push_back(std::move(row));
  return table;
}

}  // namespace roadstereo::cli
