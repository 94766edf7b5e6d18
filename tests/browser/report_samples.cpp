// Writes the files of made-up damage for the tests that open reports in a browser: report_samples FOLDER makes the
// folders none, one, many, uncalibrated, no_image and flight in it.
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <random>
#include <string>

#include "roadstereo/error.hpp"
#include "roadstereo/io/damage_files.hpp"
#include "roadstereo/io/flight_pictures.hpp"
#include "roadstereo/io/flight_report.hpp"
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
  input.head = {{"Road", "B 27"}, {"Operator", "Müller"}};
  if (with_image) input.left = pair.left.view();
  if (calibrated) {
    input.disparity = truth.disparity;
    input.calibration = pair.calibration;
  }
  if (with_image) {
    input.sheet = io::encode_png(
        io::result_sheet(pair.left.view(), 0, truth.disparity, truth.transformed, true_road_px, {}, "sample").view());
  }
  io::OutputFolder output(folder);
  io::add_damage_files(output, input);
  output.commit();
}

/// A recording of 70 m along a curve, with the damages of one pair, of which the last is a candidate.
void write_flight(const std::filesystem::path& folder, const synth::SyntheticPair& pair) {
  TrueDamage truth = damage_from_truth(pair, true);
  wear(truth);
  io::DamageReportInput pictures{truth.map};
  pictures.left = pair.left.view();
  pictures.disparity = truth.disparity;
  pictures.calibration = pair.calibration;
  io::FlightReportInput input;
  input.title = "flight <sample>";
  input.head = {{"Road", "B 27, km 3.4 to 3.5"}, {"Operator", "Müller & Söhne"}, {"Recorded", "2026-05-01 12:00 UTC"}};
  input.properties = {{"Roll", "0.12 ° (median; -0.40 … 0.52)"}, {"Engine", "cpu, 8 threads"}};
  input.metric = true;
  input.curves.in_seconds = true;
  std::vector<io::GeoFrame> frames(141);
  input.inspected = static_cast<std::int64_t>(frames.size());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const double way = 0.5 * static_cast<double>(i);
    frames[i].index = static_cast<std::int64_t>(i);
    frames[i].station_m = way;
    frames[i].roll_rad = 0.004 * std::sin(way / 9);
    frames[i].sigma_d_px = 0.06;
    frames[i].damages = 0;
    frames[i].height_m = 2.6 + 0.05 * std::cos(way / 7);
    input.track_deg.push_back({9.05 + way / 80000, 48.52 + 6e-5 * std::sin(way / 30)});
    input.curves.time.push_back(0.1 * static_cast<double>(i));
    input.curves.roll_deg.push_back(57.3 * frames[i].roll_rad);
    input.curves.height_m.push_back(frames[i].height_m);
    input.curves.sigma_d_px.push_back(0.06 + 0.01 * std::sin(way));
  }
  std::vector<io::RoadDamage> damages;
  for (const Damage& damage : truth.map.damages) {
    io::RoadDamage& known = damages.emplace_back();
    known.id = static_cast<std::int64_t>(damages.size());
    known.best = damage;
    known.best.confidence = 0.93;
    known.sightings = 4;
    known.frame_name = "000" + std::to_string(10 * damage.id) + ".png";
    known.station_m = 5.6 * damage.id;
    const auto& place = input.track_deg[static_cast<std::size_t>(2 * known.station_m)];
    known.position = io::GeoPosition{place[1], place[0], 100, 0};
  }
  damages.back().candidate = true;
  for (const io::RoadDamage& known : io::worst_first(damages, false)) {
    input.damages.push_back({known, io::road_damage_section(pictures, known.best, known.id)});
  }
  input.candidates = io::worst_first(damages, true);
  input.segments = io::road_segments(frames, damages);
  input.thumbnails = {{"0", io::frame_thumbnail(pair.left.view(), 0, truth.map)}};
  io::OutputFolder output(folder);
  output.add("report.html", io::flight_report(input));
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
    write_flight(folder / "flight", many);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
