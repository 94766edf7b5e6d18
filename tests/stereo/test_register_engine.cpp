#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <thread>
#include <vector>

#include "roadstereo/error.hpp"
#include "roadstereo/pipeline.hpp"
#include "roadstereo/synth.hpp"

namespace {

using namespace roadstereo;

/// Finds the same disparity everywhere.
class ConstantEngine final : public StereoEngine {
 public:
  void match(const MatchInput& input, const MatcherOptions& /*options*/, MatchMaps& maps) override {
    const int width = input.reference.width();
    const int height = input.reference.height();
    maps.disparity.assign(width, height, 7.25F);
    maps.winner.assign(width, height, 7);
    maps.target_winner.assign(width, height, 7);
    maps.variance.assign(width, height, 0.01F);
  }
};

std::unique_ptr<StereoEngine> make_constant(int /*threads*/) {
  return std::make_unique<ConstantEngine>();
}

TEST(Engines, AreListedFromManyThreads) {
  std::vector<std::string> first(8);
  std::vector<std::thread> threads;
  for (std::string& name : first) threads.emplace_back([&name] { name = engines().front().name; });
  for (std::thread& thread : threads) thread.join();
  for (const std::string& name : first) EXPECT_EQ(name, engines().front().name);
}

TEST(RegisterEngine, PipelineUsesIt) {
  const std::string first = resolve_engine_name("auto");
  register_engine({"constant", "7.25 px everywhere", false, make_constant});
  EXPECT_EQ(engines().back().name, "constant");
  EXPECT_EQ(resolve_engine_name("auto"), first);
  const synth::SyntheticPair pair = synth::render(synth::named_scene("demo"));
  PipelineOptions options = preset("default");
  options.engine = "constant";
  options.refinement.radius = 0;
  options.lucas_kanade.radius = 0;
  options.perspective.enabled = false;
  options.perspective.disparities = 64;
  Pipeline pipeline(options, pair.calibration);
  EXPECT_EQ(pipeline.engine_name(), "constant");
  const FrameResult& result = pipeline.process(pair.left.view(), pair.right.view());
  EXPECT_EQ(result.disparity(100, 50), 7.25F);
  EXPECT_EQ(result.disparity(result.disparity.width() - 1, result.disparity.height() - 1), 7.25F);
  EXPECT_NEAR(result.sigma(100, 50), 0.1F, 0.1F);  // of the variance
}

/// Has maps of a quarter of the image.
class SmallMapsEngine final : public StereoEngine {
 public:
  void match(const MatchInput& input, const MatcherOptions& /*options*/, MatchMaps& maps) override {
    maps.disparity.assign(input.reference.width() / 4, input.reference.height(), 7.0F);
    maps.variance.assign(input.reference.width() / 4, input.reference.height(), 0.01F);
  }
};

TEST(RegisterEngine, MapsOfAnotherSizeAreRefused) {
  register_engine({"small", "", false, [](int /*threads*/) { return std::make_unique<SmallMapsEngine>(); }});
  const synth::SyntheticPair pair = synth::render(synth::named_scene("demo"));
  PipelineOptions options = preset("default");
  options.engine = "small";
  Pipeline pipeline(options, pair.calibration);
  try {
    pipeline.process(pair.left.view(), pair.right.view());
    FAIL();
  } catch (const Error& error) {
    const std::string size = std::to_string(pair.left.width) + "×" + std::to_string(pair.left.height);
    EXPECT_NE(std::string(error.what()).find("small has matched"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find(size), std::string::npos) << error.what();
  }
}

TEST(RegisterEngine, RejectsNamesThatAreTaken) {
  EXPECT_THROW(register_engine({"cpu", "", false, make_constant}), Error);
  EXPECT_THROW(register_engine({"auto", "", false, make_constant}), Error);
  EXPECT_THROW(register_engine({"", "", false, make_constant}), Error);
  EXPECT_THROW(register_engine({"cuda", "", false, make_constant}), Error);
  EXPECT_THROW(register_engine({"nothing", "", false, nullptr}), Error);
}

}  // namespace
