#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <string>
#include <vector>

#include "io/drawing.hpp"
#include "io/plot.hpp"
#include "io/plot_axes.hpp"
#include "roadstereo/error.hpp"

namespace {

using namespace roadstereo;
using namespace roadstereo::io;

constexpr double none = std::numeric_limits<double>::quiet_NaN();
constexpr int width = 640, height = 440;

using Colour = std::array<int, 3>;

Colour colour_at(const Frame& frame, int u, int v) {
  const auto at = static_cast<std::size_t>(v * frame.width + u) * 3;
  return {frame.bytes[at], frame.bytes[at + 1], frame.bytes[at + 2]};
}

Colour series(std::size_t index) {
  const cv::Scalar colour = series_colour(index);
  return {static_cast<int>(colour[0]), static_cast<int>(colour[1]), static_cast<int>(colour[2])};
}

int count_colour(const Frame& frame, const Colour& colour, cv::Rect area) {
  int count = 0;
  for (int v = area.y; v < area.br().y; ++v) {
    for (int u = area.x; u < area.br().x; ++u) count += colour_at(frame, u, v) == colour;
  }
  return count;
}

/// The plot area of a panel whose one legend entry takes one row.
cv::Rect area_with_legend(const std::string& name) {
  PlotAxes axes;
  axes.legend = {{name, ink}};
  return plot_area(axes, {width, height});
}

Panel one_curve(std::vector<double> x, std::vector<double> y) {
  return {"title", "x, px", "y, px", {{"points", std::move(x), std::move(y)}}};
}

TEST(RoundTicks, EndWhereStepsAreBelowRounding) {
  const double lowest = 1e13, highest = 1e13 + 0.00195;
  EXPECT_LE(round_ticks(lowest, highest, 6).values.size(), 7U);
  EXPECT_EQ(round_ticks(0, 10, 6).values, (std::vector<double>{0, 2, 4, 6, 8, 10}));
}

TEST(Plot, MiddleOfRangesIsMiddleOfArea) {
  const Frame frame = draw_plot(one_curve({0, 5, 10}, {-2, 0, 2}), width, height);
  EXPECT_EQ(frame.width, width);
  EXPECT_EQ(frame.height, height);
  const cv::Rect area = area_with_legend("points");
  EXPECT_EQ(colour_at(frame, area.x + area.width / 2, area.y + area.height / 2), series(0));
}

TEST(Plot, MiddleOfLogarithmicAxisIsGeometricMean) {
  Panel panel = one_curve({1, 2, 3}, {0.01, 1, 100});
  panel.log_y = true;
  const Frame frame = draw_plot(panel, width, height);
  const cv::Rect area = area_with_legend("points");
  EXPECT_EQ(colour_at(frame, area.x + area.width / 2, area.y + area.height / 2), series(0));
}

TEST(Plot, GivenLimitIsEndOfAxis) {
  Panel panel = one_curve({0, 5, 10}, {1, 1, 1});
  panel.y_highest = 4;
  const Frame frame = draw_plot(panel, width, height);
  const cv::Rect area = area_with_legend("points");
  const int up =
      area.br().y - 1 - cvRound((area.height - 1) / 7.0);  // from 0.5, half a unit below the only value, to 4
  EXPECT_EQ(colour_at(frame, area.x + area.width / 2, up), series(0));
}

TEST(Plot, EveryCurveHasOwnColour) {
  Panel panel{"title", "x", "y", {}};
  for (int i = 0; i < 4; ++i) panel.curves.push_back({"curve", {0, 1}, {double(i), i + 1.0}});
  const Frame frame = draw_plot(panel, width, height);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_GT(count_colour(frame, series(i), {0, 0, width, height}), 100) << i;
  }
}

TEST(Plot, NanInterruptsLine) {
  const cv::Rect area = area_with_legend("line");
  const cv::Rect middle(area.x + area.width / 2 - 20, area.y, 40, area.height);
  Panel panel{"title", "x", "y", {{"line", {0, 1, 2, 3}, {0, 0, 1, 1}}}};
  EXPECT_GT(count_colour(draw_plot(panel, width, height), series(0), middle), 20);
  panel.curves[0] = {"line", {0, 1, 1.5, 2, 3}, {0, 0, none, 1, 1}};
  EXPECT_EQ(count_colour(draw_plot(panel, width, height), series(0), middle), 0);
}

template <class Call>
std::string complaint(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(NumberText, HasEveryDigit) {
  EXPECT_EQ(number_text(-0.0004, 3), "0.000");
  EXPECT_EQ(number_text(-0.5, 0), "0");
  EXPECT_EQ(number_text(-0.6, 0), "-1");
  EXPECT_EQ(number_text(2.5, 3), "2.500");
  EXPECT_EQ(number_text(1e100, 0).size(), 101U);
}

TEST(Plot, RejectsEmptyPlot) {
  const auto draw = [](const Panel& panel) { return complaint([&] { draw_plot(panel, width, height); }); };
  EXPECT_NE(draw(one_curve({}, {})).find("title"), std::string::npos);
  EXPECT_NE(draw(one_curve({1, 2}, {none, none})).find("title"), std::string::npos);
  EXPECT_NE(draw(one_curve({1, 2}, {1})).find("points"), std::string::npos);
}

}  // namespace
