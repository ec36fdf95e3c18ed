#include "hal/text/text_coverage.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

namespace pleinair::hal {
namespace {

int inkIn(Image& image, int fromX, int toX) {
  int inked = 0;
  for (int y = 0; y < image.size().height; ++y) {
    const auto row = image.row(0, y);
    for (int x = fromX; x < std::min(toX, image.size().width); ++x) {
      inked += row[static_cast<std::size_t>(x)] > 127 ? 1 : 0;
    }
  }
  return inked;
}

TEST(TextCoverage, HoldsTheTextInItsSize) {
  Image line = textCoverage("cell_size 8 px", {.fontPixels = 15, .maxWidth = 1000});
  EXPECT_EQ(line.format().pixelFormat, PixelFormat::kGrey8);
  EXPECT_GT(line.size().width, 60);
  EXPECT_LT(line.size().width, 200);
  EXPECT_GT(inkIn(line, 0, 1000), 100);
  const Image large = textCoverage("cell_size 8 px", {.fontPixels = 30, .maxWidth = 1000});
  EXPECT_NEAR(large.size().width, 2 * line.size().width, 12);
  EXPECT_NEAR(large.size().height, 2 * line.size().height, 4);
}

TEST(TextCoverage, PutsLinesUnderEachOther) {
  const Image one = textCoverage("saved", {.fontPixels = 15, .maxWidth = 1000});
  const Image three = textCoverage("saved\nsaved\nsaved", {.fontPixels = 15, .maxWidth = 1000});
  EXPECT_EQ(three.size().width, one.size().width);
  EXPECT_NEAR(three.size().height, 3 * one.size().height, 2);
}

TEST(TextCoverage, HasASecondColumn) {
  Image picture = textCoverage("q\tquit\nEscape\tquit", {.fontPixels = 15, .maxWidth = 1000});
  const int column = 10 * 15;
  EXPECT_EQ(inkIn(picture, column - 30, column), 0);
  EXPECT_GT(inkIn(picture, column, column + 40), 20);
}

TEST(TextCoverage, CutsWhatIsTooWide) {
  const std::string text = "a line that is much longer than there is room for";
  Image cut = textCoverage(text, {.fontPixels = 15, .maxWidth = 120});
  EXPECT_LE(cut.size().width, 120);
  EXPECT_EQ(cut.size().height,
            textCoverage(text, {.fontPixels = 15, .maxWidth = 1000}).size().height);
  EXPECT_GT(inkIn(cut, 0, 120), 50);
}

/// Letters that look the same in three scripts show that their glyphs are there: a missing one
/// would be a box with its number.
TEST(TextCoverage, HasGreekAndCyrillicLetters) {
  const auto drawn = [](const std::string& text) {
    const Image image = textCoverage(text, {.fontPixels = 30, .maxWidth = 1000});
    const auto bytes = image.view().planes[0].bytes;
    return std::vector<std::uint8_t>(bytes.begin(), bytes.end());
  };
  EXPECT_EQ(drawn("ΑΒΕΖΗΙΚΜΝΟΡΤΧ"), drawn("ABEZHIKMNOPTX"));
  const std::vector<std::pair<std::string, std::string>> cyrillic{
      {"А", "A"}, {"В", "B"}, {"Е", "E"}, {"М", "M"}, {"Н", "H"},
      {"О", "O"}, {"Р", "P"}, {"С", "C"}, {"Т", "T"}, {"Х", "X"}};
  for (const auto& [letter, latin] : cyrillic) EXPECT_EQ(drawn(letter), drawn(latin)) << latin;
  EXPECT_NE(drawn("ΓΔΘ"), drawn("ГДФ"));
}

TEST(TextCoverage, JoinsArabicLettersFromRightToLeft) {
  const auto drawn = [](const std::string& text) {
    return textCoverage(text, {.fontPixels = 30, .maxWidth = 1000});
  };
  // U+200C keeps letters apart.
  EXPECT_LT(drawn("ببب").size().width, drawn("ب\u200Cب\u200Cب").size().width * 8 / 10);
  // The alef, a thin stroke, is on the right: it comes first.
  Image word = drawn("اــــــ");
  const int half = word.size().width / 2;
  const auto highestIn = [&](int from, int to) {
    for (int y = 0; y < word.size().height; ++y) {
      const auto row = word.row(0, y);
      for (int x = from; x < to; ++x) {
        if (row[static_cast<std::size_t>(x)] > 127) return y;
      }
    }
    return word.size().height;
  };
  EXPECT_LT(highestIn(half, word.size().width), highestIn(0, half) - 8);
}

TEST(TextCoverage, SurvivesAnyText) {
  for (const std::string text : {"", "\n", "\t", "\xff\xfe", "·…°"}) {
    EXPECT_TRUE(isAcceptedSize(textCoverage(text, {.fontPixels = 15, .maxWidth = 100}).size()));
  }
}

/// In a process of its own, which finds fonts anew.
TEST(TextCoverageDeathTest, IsNoLargerWhereThereIsNoFont) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const support::TemporaryFolder folder;
  const auto none = folder.path() / "none.conf";
  std::ofstream(none) << "<fontconfig></fontconfig>";
  const auto sizeOfText = [&] {
    // NOLINTNEXTLINE(concurrency-mt-unsafe): the process has one thread
    setenv("FONTCONFIG_FILE", none.c_str(), 1);
    int tooLarge = 0;
    for (const char* font : {"Sans", "Sans Bold", "Serif", "Mono"}) {
      for (int px = 4; px < 40; ++px) {
        const Image text = textCoverage("4", {.font = font, .fontPixels = px, .maxWidth = 100});
        tooLarge += text.size().height > 16 * px ? 1 : 0;
      }
    }
    std::exit(tooLarge);  // NOLINT(concurrency-mt-unsafe)
  };
  EXPECT_EXIT(sizeOfText(), testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace pleinair::hal
