// The options of how strokes are made: each is an option of its own, and none breaks what is
// promised.
#include <fstream>

#include <gmock/gmock.h>

#include "hal/media/png_file.h"
#include "tests/gpu/painterly/painterly_fixture.h"
#include "tests/support/temporary_folder.h"

namespace pleinair::styles {
namespace {

using Bytes = std::vector<std::uint8_t>;

class StrokeOptionsTest : public PainterlyTest {
 protected:
  Bytes paintedWith(const char* name, const char* value, const char* relief = "2") {
    restart();
    Painterly style(library_);
    style.setParameters(style.parameters().with("relief", relief).with(name, value));
    Bytes painted;
    for (int i = 0; i < 3; ++i) painted = paint(style, next(testPicture(kSize, 5)));
    return painted;
  }
};

TEST_F(StrokeOptionsTest, FewerQuadsLookLikeTheThesiss) {
  const double difference =
      meanDifference(paintedWith("quads", "curvature"), paintedWith("quads", "thesis"));
  RecordProperty("levels", std::to_string(difference));
  EXPECT_GT(difference, 0.0);
  EXPECT_LT(difference, 3.0);
  EXPECT_GT(meanDifference(paintedWith("seed", "1"), paintedWith("seed", "2")), 3.0)
      << "the measure can fail";
}

TEST_F(StrokeOptionsTest, AheadOnlyIsAnotherPaintingOfTheSame) {
  const Bytes both = paintedWith("walk", "both");
  const Bytes ahead = paintedWith("walk", "ahead");
  const double difference = meanDifference(both, ahead);
  EXPECT_GT(difference, 1.0);
  EXPECT_LT(difference, 40.0);
}

TEST_F(StrokeOptionsTest, ReliefIsLitOnceOrOnEachStrokeAndNeverTwice) {
  const Bytes once = paintedWith("bump", "once");
  const Bytes each = paintedWith("bump", "each");
  EXPECT_GT(meanDifference(once, each), 0.3);
  const Bytes flat = paintedWith("bump", "once", "0");
  // Two programs: they may round in another way.
  EXPECT_LT(meanDifference(paintedWith("bump", "each", "0"), flat), 0.01);
  EXPECT_GT(meanDifference(each, flat), 0.3);
}

TEST_F(StrokeOptionsTest, WithoutBumpPaintHasNoRelief) {
  const Bytes off = paintedWith("bump", "off");
  EXPECT_EQ(paintedWith("bump", "off", "8"), off) << "its height does not count";
  EXPECT_GT(meanDifference(paintedWith("bump", "once"), off), 0.3);
}

TEST_F(StrokeOptionsTest, HeightIsGrey) {
  Painterly style(library_);
  const Bytes height = paint(style, next(testPicture(kSize, 5)), "height");
  int most = 0;
  for (std::size_t i = 0; i < height.size(); i += 4) {
    ASSERT_EQ(height[i], height[i + 1]);
    ASSERT_EQ(height[i], height[i + 2]);
    ASSERT_EQ(height[i + 3], 255);
    most = std::max(most, int{height[i]});
  }
  EXPECT_GT(most, 60);
}

class BrushFilesTest : public StrokeOptionsTest {
 protected:
  /// A mark of grey stripes.
  std::string write(const char* name, hal::FrameSize size) {
    hal::Image image({.pixelFormat = hal::PixelFormat::kGrey8, .size = size});
    for (int y = 0; y < size.height; ++y) {
      for (auto& each : image.row(0, y)) each = y / 8 % 2 == 0 ? 255 : 60;
    }
    const auto path = folder_.path() / name;
    hal::orThrow(hal::writePng(path, image.view()));
    return path.string();
  }

  support::TemporaryFolder folder_;
};

TEST_F(BrushFilesTest, AFilesBrushPaints) {
  const std::string one = write("one.png", {256, 64});
  Painterly style(library_);
  const config::ParameterValues builtIn = style.parameters();
  const config::ParameterValues own = builtIn.with("brush_file", one);
  const hal::Image image = testPicture(kSize, 5);
  const auto paintedWith = [&](const config::ParameterValues& values) {
    style.reset();
    hal::orThrow(style.prepare(values));
    style.setParameters(values);
    return paint(style, next(image));
  };
  const Bytes flat = paintedWith(builtIn);
  const Bytes striped = paintedWith(own);
  EXPECT_GT(meanDifference(flat, striped), 1.0);
  EXPECT_EQ(paintedWith(own.with("brush", "knife")), striped) << "the built-in one does not count";
  EXPECT_EQ(paintedWith(builtIn), flat);
}

TEST_F(BrushFilesTest, ABadOneIsRefusedAndThePaintingGoesOn) {
  Painterly style(library_);
  const hal::Image image = testPicture(kSize, 5);
  const Bytes before = paint(style, next(image));
  const config::ParameterValues bad =
      style.parameters().with("brush_file", write("odd.png", {100, 30}));
  const hal::Result<void> prepared = style.prepare(bad);
  ASSERT_FALSE(prepared);
  EXPECT_THAT(prepared.error().message(), testing::HasSubstr("is 100x30 px"));
  EXPECT_FALSE(painterlyKind().check(bad));
  EXPECT_TRUE(painterlyKind().check(style.parameters()));
  style.reset();
  EXPECT_EQ(paint(style, next(image)), before);
}

}  // namespace
}  // namespace pleinair::styles
