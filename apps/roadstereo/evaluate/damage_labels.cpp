#include "evaluate/damage_labels.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include "core/require_size.hpp"
#include "evaluate/label_regions.hpp"
#include "evaluate/scan_frames.hpp"
#include "map_source.hpp"
#include "mask_file.hpp"
#include "roadstereo/damage.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/pipeline.hpp"

namespace roadstereo::cli {
namespace {

namespace fs = std::filesystem;

bool is_depression(const DamageMap& map, std::uint16_t id) {
  return id != 0 && map.damages[id - 1U].kind == DamageKind::depression;
}

/// Count labels, found labels and false positives.
void count_regions(const DamageMap& map, const Image<std::uint8_t>& label, LabelResult& result) {
  const LabelRegions regions = label_regions(label);
  std::vector<std::size_t> covered(regions.sizes.size(), 0);
  std::map<std::uint16_t, std::size_t> labelled_pixels;  // by id of the damage
  for (int v = 0; v < label.height(); ++v) {
    for (int u = 0; u < label.width(); ++u) {
      const int region = regions.ids(u, v);
      if (label(u, v) == 0 || !is_depression(map, map.ids(u, v))) continue;
      ++labelled_pixels[map.ids(u, v)];  // also of components too small to count
      if (region != 0) ++covered[static_cast<std::size_t>(region - 1)];
    }
  }
  result.labels = regions.sizes.size();
  for (std::size_t k = 0; k < covered.size(); ++k) {
    const bool is_found = static_cast<double>(covered[k]) >= min_damage_share * static_cast<double>(regions.sizes[k]);
    result.found += is_found ? 1U : 0U;
  }
  for (const Damage& damage : map.damages) {
    if (damage.kind != DamageKind::depression) continue;
    const double labelled = static_cast<double>(labelled_pixels[static_cast<std::uint16_t>(damage.id)]);
    result.false_positives += labelled < min_damage_share * static_cast<double>(damage.pixels) ? 1U : 0U;
  }
}

LabelResult score_frame(const std::string& name, const DamageMap& map, const Image<std::uint8_t>& label,
                        const Image<float>& measured, const std::string& label_file) {
  require_same_size(label_file.c_str(), map_size(label), "the map", map_size(map.ids));
  LabelResult result;
  result.frame = name;
  for (int v = 0; v < label.height(); ++v) {
    for (int u = 0; u < label.width(); ++u) {
      result.score.add(is_depression(map, map.ids(u, v)), label(u, v) != 0);
      result.measured += label(u, v) != 0 && !std::isnan(measured(u, v)) ? 1U : 0U;
    }
  }
  count_regions(map, label, result);
  result.regions = found_regions(name, map, [&](int u, int v) { return label(u, v) != 0; });
  return result;
}

std::string image_of(const fs::path& root, const std::string& name) {
  for (const char* ending : {".jpg", ".png"}) {
    const fs::path path = root / "rgb" / (name + ending);
    if (fs::is_regular_file(path)) return path.string();
  }
  return "";
}

std::vector<fs::path> maps_in(const fs::path& folder) {
  std::vector<fs::path> maps;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".png") maps.push_back(entry.path());
  }
  std::sort(maps.begin(), maps.end());
  if (maps.empty()) fail(folder.string(), ": the folder contains no PNG file");
  return maps;
}

}  // namespace

std::vector<LabelResult> score_labelled_maps(const std::string& folder) {
  const fs::path root = folder;
  std::vector<LabelResult> results;
  for (const fs::path& path : maps_in(root / "disp_tg")) {
    const std::string name = path.stem().string();
    const TransformedMap source = read_transformed_map({path.string(), image_of(root, name), "", {}});
    GreyImage grey;
    if (source.image) to_grey(source.image->view(), 0, grey);
    DamageInput input;
    input.transformed = source.transformed;
    input.grey = grey;
    const std::string label = (root / "label" / path.filename()).string();
    results.push_back(score_frame(name, find_damage(input), read_mask(label), source.transformed, label));
    results.back().method = "given map";
  }
  return results;
}

std::vector<LabelResult> score_labelled_pairs(const std::string& folder, const std::vector<DamageMethod>& methods) {
  std::vector<LabelResult> results;
  const std::vector<LabelledFiles> frames = find_labelled_pairs(folder);
  for (const DamageMethod& method : methods) {
    for (const LabelledFiles& files : frames) {
      const StereoPair pair = read_pair(files.pair);
      const FrameDamage found = find_damage_of(method, pair, files.name);
      results.push_back(score_frame(files.name, found.map, read_mask(files.label), found.frame.disparity, files.label));
      results.back().method = method.name;
    }
  }
  return results;
}

Table label_table(const std::vector<LabelResult>& results) {
  constexpr double percent = 100;
  Table table{"Depressions against the labels",
              {{"method", "method"},
               {"frame", "frame"},
               {"precision", "precision"},
               {"recall", "recall"},
               {"F", "f"},
               {"labels", "labels"},
               {"found", "found"},
               {"false positives", "false_positives"},
               {"measured %", "measured_percent"}},
              {}};
  const auto row = [&](const LabelResult& one) -> std::vector<Cell> {
    return {Cell(one.method),
            Cell(one.frame),
            Cell(one.score.precision(), 3),
            Cell(one.score.recall(), 3),
            Cell(one.score.f(), 3),
            Cell(static_cast<double>(one.labels), 0),
            Cell(static_cast<double>(one.found), 0),
            Cell(static_cast<double>(one.false_positives), 0),
            Cell(percent * static_cast<double>(one.measured) / static_cast<double>(one.score.truth), 1)};
  };
  LabelResult all;
  for (std::size_t i = 0; i < results.size(); ++i) {
    const LabelResult& one = results[i];
    all.method = one.method;
    all.frame = "all pixels";
    table.rows.push_back(row(one));
    all.score.add(one.score);
    all.labels += one.labels;
    all.found += one.found;
    all.false_positives += one.false_positives;
    all.measured += one.measured;
    if (i + 1 < results.size() && results[i + 1].method == one.method) continue;
    table.rows.push_back(row(all));
    all = {};
  }
  return table;
}

}  // namespace roadstereo::cli
