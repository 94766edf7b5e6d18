// Writes the files of made-up damage for the tests that open reports in a browser: report_samples FOLDER makes the
// folders none, one, many, uncalibrated and no_image in it.
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <random>
#include <string>

#include "roadstereo/error.hpp"
#include "roadstereo/io/damage_files.hpp"
#include "roadstereo/io/image_file.hpp"
#include "roadstereo/io/pictures.hpp"
#include "tests/damage/damage_from_truth.hpp"

namespace {

using namespace roadstereo;

synth::Scene sample_scene() {
  synth::Scene scene = synth::named_scene("uav");
  scene.rig.width = 960;
  scene.rig.height = 540;
  scene.rig.focal_px = 525;
  scene.rig.pitch_deg = 62;
  scene.supersampling = 2;
  scene.road.blobs.clear();
  scene.road.cracks.clear();
  return scene;
}

synth::Scene one_pothole() {
  synth::Scene scene = sample_scene();
  scene.road.blobs = {{0.1, 1.5, 0.3, 0.062, 0.3, 0.3, 4}};
  return scene;
}

synth::Scene many_damages() {
  synth::Scene scene = sample_scene();
  for (int i = 0; i < 11; ++i) {
    const double x = -1.6 + 0.9 * (i % 4) + 0.15 * (i % 3), y = 0.45 + 0.95 * (i / 4) + 0.1 * (i % 2);
    const double depth = (i % 4 == 3 ? -1 : 1) * (0.008 + 0.0065 * i);
    scene.road.blobs.push_back({x, y, 0.07 + 0.02 * i, depth, 0.35, 0.35, static_cast<std::uint32_t>(i + 3)});
  }
  scene.road.cracks = {{{{-1.2, 0.2}, {-0.5, 0.25}, {0.3, 0.1}}, 0.02, 0.03, 0.5, 3}};
  return scene;
}

/// What a matcher adds: noise, and holes that are interpolated.
void wear(TrueDamage& truth) {
  std::mt19937 random(5);
  const float scale = truth.map.metric ? 0.0009F : 0.04F;
  std::normal_distribution<float> noise(0, scale);
  for (int v = 0; v < truth.map.depth.height(); ++v) {
    for (int u = 0; u < truth.map.depth.width(); ++u) truth.map.depth(u, v) += noise(random);
  }
  for (Damage& damage : truth.map.damages) {
    std::size_t measured = 0;
    const auto& [u0, v0, u1, v1] = damage.box_px;
    const int reach = std::max(2, (u1 - u0) / 9), middle = u0 + (u1 - u0) / 3;
    for (int v = std::max(0, damage.deepest_px[1] - reach); v <= std::min(v1, damage.deepest_px[1] + reach); ++v) {
      for (int u = middle - reach; u <= middle + reach; ++u) {
        if (u < 0 || u >= truth.disparity.width()) continue;
        truth.disparity(u, v) = truth::nan_value;
        truth.transformed(u, v) = truth::nan_value;
      }
    }
    for (int v = v0; v <= v1; ++v) {
      for (int u = u0; u <= u1; ++u) {
        if (truth.map.ids(u, v) == damage.id && std::isfinite(truth.transformed(u, v))) ++measured;
      }
    }
    damage.measured_share = static_cast<double>(measured) / static_cast<double>(damage.pixels);
  }
}

void write_sample(const std::filesystem::path& folder, const synth::SyntheticPair& pair, bool calibrated,
                  bool with_image) {
  TrueDamage truth = damage_from_truth(pair, calibrated);
  wear(truth);
  io::DamageReportInput input{truth.map};
  input.transformed = truth.transformed;
  input.title = folder.filename().string() + " <sample> & \"quotes\"";
  input.properties = {{"roll", "0.012° ± 0.004°"},
                      {"camera height", "2.600 m"},
                      {"looking", "62.0° below the horizon"},
                      {"noise", "0.050 px"},
                      {"preset", "default"}};
  if (with_image) input.left = pair.left.view();
  if (calibrated) {
    input.disparity = truth.disparity;
    input.calibration = pair.calibration;
  }
  if (with_image) {
    input.sheet = io::encode_png(
        io::result_sheet(pair.left.view(), truth.disparity, truth.transformed, true_road_px, {}, "sample").view());
  }
  io::OutputFolder output(folder);
  io::add_damage_files(output, input);
  output.commit();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: report_samples FOLDER\n");
    return 2;
  }
  try {
    const std::filesystem::path folder = argv[1];
    const synth::SyntheticPair intact = synth::render(sample_scene());
    const synth::SyntheticPair one = synth::render(one_pothole());
    const synth::SyntheticPair many = synth::render(many_damages());
    write_sample(folder / "none", intact, true, true);
    write_sample(folder / "one", one, true, true);
    write_sample(folder / "many", many, true, true);
    write_sample(folder / "uncalibrated", many, false, true);
    write_sample(folder / "no_image", one, false, false);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
