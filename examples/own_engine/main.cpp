// A matcher of one's own as an engine of the pipeline: sums of absolute differences over 9×9 blocks. The pipeline finds
// the road, transforms the target image, and refines and transforms what the engine has found.
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <limits>
#include <roadstereo/roadstereo.hpp>
#include <roadstereo/synth.hpp>

namespace {

using namespace roadstereo;

class BlockDifferences final : public StereoEngine {
 public:
  void match(const MatchInput& input, const MatcherOptions&, MatchMaps& maps) override {
    const int width = input.reference.width();
    const int height = input.reference.height();
    maps.disparity.assign(width, height, std::numeric_limits<float>::quiet_NaN());
    maps.variance.assign(width, height, std::numeric_limits<float>::infinity());
    maps.winner.assign(width, height, -1);
    maps.target_winner.assign(width, height, -1);
    for (int v = radius; v < height - radius; ++v) {
      for (int u = radius; u < width - radius; ++u) match_pixel(input, u, v, maps);
    }
  }

 private:
  static constexpr int radius = 4;

  /// First column of the target that has grey levels in all rows of the block.
  static int first_column(const MatchInput& input, int v) {
    int first = 0;
    for (int y = v - radius; y <= v + radius && input.first_column != nullptr; ++y) {
      first = std::max(first, input.first_column[y]);
    }
    return first;
  }

  static int difference(const MatchInput& input, int u, int v, int d) {
    int sum = 0;
    for (int y = v - radius; y <= v + radius; ++y) {
      for (int x = u - radius; x <= u + radius; ++x) sum += std::abs(input.reference(x, y) - input.target(x - d, y));
    }
    return sum;
  }

  static void match_pixel(const MatchInput& input, int u, int v, MatchMaps& maps) {
    const int last = std::min(input.disparities - 1, u - radius - first_column(input, v));
    int best = -1;
    int lowest = std::numeric_limits<int>::max();
    for (int d = 0; d <= last; ++d) {
      const int sum = difference(input, u, v, d);
      if (sum < lowest) {
        lowest = sum;
        best = d;
      }
    }
    if (best < 1 || best >= last) return;  // no minimum inside the range
    const double before = difference(input, u, v, best - 1);
    const double after = difference(input, u, v, best + 1);
    const double slope = std::max(before, after) - lowest;
    if (slope <= 0) return;
    maps.winner(u, v) = static_cast<std::int16_t>(best);
    maps.target_winner(u - best, v) = static_cast<std::int16_t>(best);
    maps.disparity(u, v) = static_cast<float>(best + 0.5 * (before - after) / slope);
    const double spread = lowest / slope;  // of the disparity, pixels: noise over steepness
    maps.variance(u, v) = static_cast<float>(spread * spread / 81);
  }
};

}  // namespace

int main() {
  try {
    register_engine({"differences", "sums of absolute differences", false,
                     [](int) { return std::make_unique<BlockDifferences>(); }});
    synth::Scene scene = synth::named_scene("uav");
    scene.rig.focal_px *= 320.0 / scene.rig.width;
    scene.rig.width = 320;
    scene.rig.height = 180;
    const synth::SyntheticPair pair = synth::render(scene);

    PipelineOptions options = preset("default");
    options.engine = "differences";
    Pipeline pipeline(options, pair.calibration);
    const FrameResult& result = pipeline.process(pair.left.view(), pair.right.view());

    double sum = 0, count = 0;
    for (int v = 0; v < result.disparity.height(); ++v) {
      for (int u = 0; u < result.disparity.width(); ++u) {
        const double error = result.disparity(u, v) - pair.disparity(u, v);
        if (pair.visible(u, v) == 0 || !std::isfinite(error)) continue;
        sum += std::abs(error);
        ++count;
      }
    }
    std::cout << "mean error " << sum / count << " px of " << 100 * result.valid_share << " % of the pixels, roll "
              << result.geometry.roll_rad << " rad, the truth is " << pair.roll_rad << "\n";
    return sum / count < 0.5 ? 0 : 1;
  } catch (const roadstereo::Error& error) {
    std::cerr << error.what() << "\n";
    return 2;
  }
}
