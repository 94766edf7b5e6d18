// Lines of text in pictures.

#include <gtest/gtest.h>

#include "io/text_line.hpp"

namespace roadstereo::io {
namespace {

bool equal(const TextLine& one, const TextLine& other) {
  return one.cover.size() == other.cover.size() && cv::norm(one.cover, other.cover, cv::NORM_INF) == 0;
}

TEST(TextLine, CapitalsHaveHeightAndStandOnBaseLine) {
  for (const int height : {9, 14, 20, 64}) {
    const TextLine line = render_line("H", height);
    EXPECT_NEAR(line.cover.rows, height, 1) << height;
    EXPECT_NEAR(line.origin.y, -height, 1) << height;
    double darkest = 0;
    cv::minMaxLoc(line.cover, nullptr, &darkest);
    EXPECT_EQ(darkest, 255) << height;
  }
  EXPECT_GT(render_line("g", 20).origin.y + render_line("g", 20).cover.rows, 2) << "descender";
}

TEST(TextLine, WidthIsSumOfAdvances) {
  const int four = render_line("0000", 32).width, eight = render_line("00000000", 32).width;
  EXPECT_NEAR(eight, 2 * four, 1);
  EXPECT_GT(render_line("a b", 32).width, render_line("ab", 32).width);
}

TEST(TextLine, HasSignsOfUnits) {
  const TextLine question = render_line("?", 20);
  for (const char* text : {"±", "°", "²", "µ", "×", "σ", "–", "…", "−", "≤"}) {
    const TextLine line = render_line(text, 20);
    EXPECT_FALSE(line.cover.empty()) << text;
    EXPECT_FALSE(equal(line, question)) << text;
  }
}

TEST(TextLine, ShowsWhatFontLacksAsQuestionMark) {
  const TextLine question = render_line("?", 20);
  EXPECT_TRUE(equal(render_line("路", 20), question));
  EXPECT_TRUE(equal(render_line("\xff", 20), question)) << "no UTF-8";
  EXPECT_TRUE(equal(render_line("\xc3", 20), question)) << "cut off";
}

TEST(TextLine, TextWithoutInkIsEmpty) {
  EXPECT_TRUE(render_line("", 20).cover.empty());
  EXPECT_EQ(render_line("", 20).width, 0);
  EXPECT_TRUE(render_line("  ", 20).cover.empty());
  EXPECT_GT(render_line("  ", 20).width, 0);
}

}  // namespace
}  // namespace roadstereo::io
