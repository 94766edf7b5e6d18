#include "roadstereo/io/damage_files.hpp"

#include "roadstereo/io/damage_overlay.hpp"
#include "roadstereo/io/damage_table.hpp"
#include "roadstereo/io/image_file.hpp"
#include "roadstereo/io/label_image.hpp"

namespace roadstereo::io {

void add_damage_files(OutputFolder& folder, const DamageReportInput& input) {
  const Frame background = damage_background(input);
  folder.add("damages.json", damages_json(input.map));
  folder.add("damages.csv", damages_csv(input.map));
  folder.add("damage.png", encode_label_png(input.map.ids));
  folder.add("overlay.png", encode_png(damage_overlay(background.view(), 0, input.map).view()));
  folder.add("report.html", damage_report(input));
}

}  // namespace roadstereo::io
