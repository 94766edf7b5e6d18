#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <new>
#include <string>
#include <thread>
#include <vector>

#include "road/map_sample.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/pipeline.hpp"
#include "roadstereo/synth.hpp"
#include "roadstereo/warning.hpp"

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
  // The variance of the engine, and that of interpolation and calibration.
  EXPECT_NEAR(result.sigma(100, 50), std::sqrt(0.01 + std::pow(options.refinement.min_sigma_px, 2)), 1e-5);
}

TEST(RegisterEngine, EntriesStayWhereTheyAre) {
  const EngineInfo &best = find_engine("auto"), &oracle = find_engine("reference");
  const std::size_t before = engines().size();
  constexpr std::size_t added = 20;
  for (std::size_t i = 0; i < added; ++i) register_engine({"spare " + std::to_string(i), "", false, make_constant});
  EXPECT_EQ(engines().size(), before + added);
  EXPECT_EQ(&find_engine("auto"), &best);
  EXPECT_EQ(&find_engine("reference"), &oracle);
  EXPECT_EQ(best.name, engines().front().name);
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

/// Finds disparities everywhere but in the rows that the road geometry is fitted to, of which the first few have some.
class UnsampledRowsEngine final : public StereoEngine {
 public:
  explicit UnsampledRowsEngine(int sampled_rows) : sampled_rows_(sampled_rows) {}

  void match(const MatchInput& input, const MatcherOptions& /*options*/, MatchMaps& maps) override {
    const int width = input.reference.width(), height = input.reference.height();
    maps.disparity.assign(width, height, 7.25F);
    maps.variance.assign(width, height, 0.01F);
    const MapSample sample = map_sample(width, height);
    for (int row = sampled_rows_; row < sample.rows; ++row) {
      std::fill_n(maps.disparity.row(sample.at(row)), width, std::numeric_limits<float>::quiet_NaN());
    }
  }

 private:
  int sampled_rows_;
};

// The first has no sample at all, the samples of the other lie on one line.
TEST(RegisterEngine, DisparitiesWithoutRoadGeometryAreWarning) {
  const synth::SyntheticPair pair = synth::render(synth::named_scene("demo"));
  ASSERT_GT(map_sample(pair.left.width, pair.left.height).step, 1);
  for (const int rows : {0, 1}) {
    PipelineOptions options = preset("default");
    options.engine = "unsampled " + std::to_string(rows);
    options.refinement.radius = 0;
    options.lucas_kanade.radius = 0;
    register_engine(
        {options.engine, "", false, [rows](int /*threads*/) { return std::make_unique<UnsampledRowsEngine>(rows); }});
    Pipeline pipeline(options, pair.calibration);
    const FrameResult& result = pipeline.process(pair.left.view(), pair.right.view());
    EXPECT_TRUE(result.road.has_road());
    EXPECT_FALSE(result.roll_found);
    EXPECT_GT(result.valid_share, 0.5);
    EXPECT_TRUE(std::any_of(result.warnings.begin(), result.warnings.end(),
                            [](const std::string& warning) { return warning_code(warning) == "few-disparities"; }));
    EXPECT_TRUE(std::isnan(result.transformed(100, 50)));
  }
}

/// Fails from its second frame on.
class FailingEngine final : public StereoEngine {
 public:
  void match(const MatchInput& input, const MatcherOptions& options, MatchMaps& maps) override {
    if (++frames_ > 1) throw std::bad_alloc();
    cpu_->match(input, options, maps);
  }

 private:
  std::unique_ptr<StereoEngine> cpu_ = make_engine("cpu", 1);
  int frames_ = 0;
};

TEST(RegisterEngine, WarmUpThatFailsLeavesNoRoad) {
  register_engine({"failing", "", false, [](int /*threads*/) { return std::make_unique<FailingEngine>(); }});
  PipelineOptions options = preset("fast");
  options.engine = "failing";
  Pipeline pipeline(options);
  EXPECT_THROW(pipeline.warm_up(320, 180), std::bad_alloc);
  EXPECT_EQ(pipeline.carried().width, 0);
  EXPECT_FALSE(pipeline.carried().road.has_value());
}

TEST(RegisterEngine, RejectsNamesThatAreTaken) {
  EXPECT_THROW(register_engine({"cpu", "", false, make_constant}), Error);
  EXPECT_THROW(register_engine({"auto", "", false, make_constant}), Error);
  EXPECT_THROW(register_engine({"", "", false, make_constant}), Error);
  EXPECT_THROW(register_engine({"cuda", "", false, make_constant}), Error);
  EXPECT_THROW(register_engine({"nothing", "", false, nullptr}), Error);
}

}  // namespace
