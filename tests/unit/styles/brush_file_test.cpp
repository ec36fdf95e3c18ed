// Brushes from PNG files: what of a picture is paint and height, and what is refused how.
#include "pipeline/styles/strokes/brush_file.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>

#include "hal/image.h"
#include "hal/media/png_file.h"
#include "tests/support/temporary_folder.h"

namespace pleinair::styles {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

class BrushFileTest : public testing::Test {
 protected:
  /// Writes a picture whose pixel (x, y) is `colourAt`'s: r, g, b and perhaps a.
  template <class ColourAt>
  fs::path write(const char* name, hal::PixelFormat format, hal::FrameSize size,
                 const ColourAt& colourAt) {
    hal::Image image({.pixelFormat = format, .size = size});
    const std::size_t channels = image.row(0, 0).size() / static_cast<std::size_t>(size.width);
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) {
        const std::array<int, 4> colour = colourAt(x, y);
        for (std::size_t c = 0; c < channels; ++c) {
          image.row(0, y)[static_cast<std::size_t>(x) * channels + c] =
              static_cast<std::uint8_t>(colour.at(c));
        }
      }
    }
    const fs::path path = folder_.path() / name;
    hal::orThrow(hal::writePng(path, image.view()));
    return path;
  }

  support::TemporaryFolder folder_;
};

std::uint8_t at(const BrushMarks& marks, int x, int y, int channel) {
  return marks.texels.at(static_cast<std::size_t>(((y * marks.across * 4) + x) * 2 + channel));
}

TEST_F(BrushFileTest, GreyIsPaintAndHeight) {
  const auto marks =
      readBrushFile(write("grey.png", hal::PixelFormat::kGrey8, {64, 16}, [](int x, int y) {
        return std::array{x + 4 * y, 0, 0, 0};
      }));
  ASSERT_TRUE(marks) << marks.error().message();
  EXPECT_EQ(marks->across, 16);
  EXPECT_EQ(marks->variants, 1);
  ASSERT_EQ(marks->texels.size(), 64U * 16 * 2);
  for (const int channel : {0, 1}) {
    EXPECT_EQ(at(*marks, 5, 7, channel), 33);
    EXPECT_EQ(at(*marks, 63, 15, channel), 123);
  }
}

TEST_F(BrushFileTest, ColourIsPaintInItsRedAndHeightInItsGreen) {
  const auto marks =
      readBrushFile(write("colour.png", hal::PixelFormat::kRgb8, {64, 64}, [](int x, int y) {
        return std::array{x, y, 200, 0};
      }));
  ASSERT_TRUE(marks) << marks.error().message();
  EXPECT_EQ(marks->across, 16);
  EXPECT_EQ(marks->variants, 4);
  EXPECT_EQ(at(*marks, 40, 50, 0), 40);
  EXPECT_EQ(at(*marks, 40, 50, 1), 50);
}

TEST_F(BrushFileTest, WhatIsTransparentHasNoPaint) {
  const auto marks =
      readBrushFile(write("alpha.png", hal::PixelFormat::kRgba8, {64, 16}, [](int x, int) {
        return std::array{200, 100, 0, x < 32 ? 0 : (x == 32 ? 128 : 255)};
      }));
  ASSERT_TRUE(marks) << marks.error().message();
  EXPECT_EQ(at(*marks, 31, 3, 0), 0);
  EXPECT_EQ(at(*marks, 31, 3, 1), 0);
  EXPECT_EQ(at(*marks, 32, 3, 0), 100);
  EXPECT_EQ(at(*marks, 32, 3, 1), 50);
  EXPECT_EQ(at(*marks, 33, 3, 0), 200);
}

TEST_F(BrushFileTest, OtherShapesAndSizesAreRefusedInOneLine) {
  for (const hal::FrameSize size : {hal::FrameSize{64, 32},
                                    {28, 7},
                                    {28, 28},
                                    {66, 66},
                                    {1028, 257},
                                    {2048, 512},
                                    {16, 64},
                                    {1, 1}}) {
    SCOPED_TRACE(size.width);
    const auto marks = readBrushFile(write("odd.png", hal::PixelFormat::kGrey8, size, [](int, int) {
      return std::array{1, 0, 0, 0};
    }));
    ASSERT_FALSE(marks);
    EXPECT_EQ(marks.error().kind, hal::ErrorKind::kInvalidInput);
    EXPECT_THAT(marks.error().message(), HasSubstr("odd.png: is "));
    EXPECT_THAT(marks.error().message(), HasSubstr("four times as wide as high"));
    EXPECT_THAT(marks.error().message(), Not(HasSubstr("\n")));
  }
  for (const hal::FrameSize size : {hal::FrameSize{32, 8}, {32, 32}, {1024, 256}, {1024, 1024}}) {
    const fs::path path = write("sound.png", hal::PixelFormat::kGrey8, size, [](int, int) {
      return std::array{90, 0, 0, 0};
    });
    EXPECT_TRUE(readBrushFile(path)) << size.width << "x" << size.height;
  }
}

TEST_F(BrushFileTest, OnesWithoutPaintAreRefusedWithTheReason) {
  const auto colours = {std::array{0, 0, 0, 255}, std::array{0, 255, 255, 255},
                        std::array{255, 255, 255, 0}, std::array{3, 3, 3, 255}};
  for (const std::array<int, 4>& colour : colours) {
    const auto marks = readBrushFile(
        write("black.png", hal::PixelFormat::kRgba8, {64, 16}, [&](int, int) { return colour; }));
    ASSERT_FALSE(marks);
    EXPECT_EQ(marks.error().kind, hal::ErrorKind::kInvalidInput);
    EXPECT_THAT(marks.error().message(), HasSubstr("black.png: has no paint in it"));
    EXPECT_THAT(marks.error().message(), HasSubstr("paint is white"));
  }
  EXPECT_TRUE(readBrushFile(write("dot.png", hal::PixelFormat::kGrey8, {64, 16}, [](int x, int y) {
    return std::array{x == 5 && y == 5 ? 255 : 0, 0, 0, 0};
  })));
}

TEST_F(BrushFileTest, WhatIsNoPngIsSaid) {
  const auto kindOf = [&](const fs::path& path) {
    const auto marks = readBrushFile(path);
    EXPECT_FALSE(marks);
    return marks ? hal::ErrorKind::kInternal : marks.error().kind;
  };
  EXPECT_EQ(kindOf(folder_.path() / "none.png"), hal::ErrorKind::kNotFound);
  EXPECT_EQ(kindOf(folder_.path()), hal::ErrorKind::kInvalidInput);
  std::ofstream(folder_.path() / "text.png") << "a brush, one would think";
  EXPECT_THAT(readBrushFile(folder_.path() / "text.png").error().message(), HasSubstr("is no PNG"));
  std::ofstream(folder_.path() / "empty.png").flush();
  EXPECT_EQ(kindOf(folder_.path() / "empty.png"), hal::ErrorKind::kInvalidInput);

  const fs::path whole = write("whole.png", hal::PixelFormat::kGrey8, {64, 16}, [](int x, int y) {
    return std::array{(x * 37 + y * 91) % 256, 0, 0, 0};
  });
  fs::resize_file(whole, fs::file_size(whole) / 2);
  EXPECT_EQ(kindOf(whole), hal::ErrorKind::kInvalidInput);
  std::ofstream(folder_.path() / "big.png").seekp(20 << 20) << "x";
  EXPECT_THAT(readBrushFile(folder_.path() / "big.png").error().message(), HasSubstr("20 MiB"));
}

TEST(BrushFiles, MalformedOnesAreRefusedOrSound) {
  const fs::path folder = fs::path(PLEINAIR_SHARED_DATA) / "malformed";
  if (!fs::is_directory(folder)) GTEST_SKIP() << "test data is not here: " << folder;
  int files = 0;
  for (const char* kind : {"images", "png"}) {
    for (const fs::directory_entry& entry : fs::directory_iterator(folder / kind)) {
      SCOPED_TRACE(entry.path());
      ++files;
      const auto marks = readBrushFile(entry.path());
      if (marks) {
        EXPECT_EQ(marks->texels.size(),
                  std::size_t{8} *
                      static_cast<std::size_t>(marks->across * marks->across * marks->variants));
        continue;
      }
      EXPECT_THAT(marks.error().message(), HasSubstr(entry.path().filename().string()));
      EXPECT_THAT(marks.error().message(), Not(HasSubstr("\n")));
    }
  }
  EXPECT_GE(files, 30);
}

TEST(BrushMarks, AreReducedToMeansAndNeverEnlarged) {
  BrushMarks marks{.across = 16, .variants = 4, .texels = {}};
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      marks.texels.push_back(static_cast<std::uint8_t>(x % 2 == 0 ? 0 : 200));  // paint
      marks.texels.push_back(static_cast<std::uint8_t>(y < 32 ? 40 : 80));      // height
    }
  }
  const BrushMarks reduced = reducedTo(marks, 8);
  EXPECT_EQ(reduced.across, 8);
  EXPECT_EQ(reduced.variants, 4);
  ASSERT_EQ(reduced.texels.size(), 32U * 32 * 2);
  for (int y = 0; y < 32; ++y) {
    EXPECT_EQ(at(reduced, 7, y, 0), 100);
    EXPECT_EQ(at(reduced, 7, y, 1), y < 16 ? 40 : 80) << y;
  }
  EXPECT_EQ(reducedTo(marks, 64).texels, marks.texels);
  EXPECT_EQ(reducedTo(marks, 5).texels.size(), 20U * 20 * 2) << "any size will do";
}

}  // namespace
}  // namespace pleinair::styles
