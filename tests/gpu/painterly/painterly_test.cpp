// The painter as a whole: what it promises about time, sizes, views and looks.
#include <algorithm>
#include <array>
#include <cstdlib>
#include <set>
#include <string>

#include <gmock/gmock.h>

#include "pipeline/marks/anchors/anchor_set.h"
#include "pipeline/styles/painterly/painterly_parameters.h"
#include "pipeline/styles/strokes/brushes.h"
#include "tests/gpu/painterly/painterly_fixture.h"
#include "tests/support/allocation_count.h"

namespace pleinair::styles {
namespace {

using Bytes = std::vector<std::uint8_t>;

double variance(const Bytes& picture) {
  double sum = 0.0;
  double squares = 0.0;
  double count = 0.0;
  for (std::size_t i = 0; i < picture.size(); i += 4) {
    const double luma = 0.299 * picture[i] + 0.587 * picture[i + 1] + 0.114 * picture[i + 2];
    sum += luma;
    squares += luma * luma;
    count += 1.0;
  }
  return squares / count - (sum / count) * (sum / count);
}

TEST_F(PainterlyTest, GivesTheSamePicturesOnEveryRunAndBesideAnother) {
  Painterly first(library_);
  Painterly second(library_);
  second.setParameters(second.parameters().with("seed", "9"));
  std::vector<Bytes> alone;
  for (int i = 0; i < 4; ++i) alone.push_back(paint(first, next(3.0 * i, 3.0)));
  first.reset();
  restart();
  for (std::size_t i = 0; i < 4; ++i) {
    const scene::ArFrame frame = next(3.0 * static_cast<double>(i), 3.0);
    EXPECT_EQ(paint(first, frame), alone[i]) << "frame " << i;
    EXPECT_NE(paint(second, frame), alone[i]);
  }
}

TEST_F(PainterlyTest, CompilesEachProgramOnceWhateverTheLayersLooksAndSizes) {
  std::size_t before = 0;
  for (const SceneContents contents : {SceneContents::kCameraOnly, SceneContents::kModels}) {
    Painterly style(library_, contents);
    const std::size_t compiled = library_.compiledPrograms();
    EXPECT_GE(compiled, before + 4) << "scenes with models have programs of their own";
    before = compiled;
    for (const Look& look : style.kind().looks) {
      style.setParameters(style.kind().parametersOf(look.name));
      for (const hal::FrameSize size : {kSize, hal::FrameSize{96, 72}}) {
        scene::ArFrame frame = next(0.0, 0.0, size);
        frame.sceneHasModels = contents == SceneContents::kModels;
        paint(style, frame);
        EXPECT_EQ(library_.compiledPrograms(), compiled) << look.name;
      }
    }
    const Painterly another(library_, contents);
    EXPECT_EQ(library_.compiledPrograms(), compiled);
  }
}

TEST_F(PainterlyTest, MakesNoBrushInAPaintedFrame) {
  Painterly style(library_);
  const std::uint64_t made = brushesMade();
  for (const Look& look : style.kind().looks) {
    style.setParameters(style.kind().parametersOf(look.name));
    for (const char* const pixels : {"2", "12"}) {
      style.setParameters(style.parameters().with("stroke_size", pixels));
      paint(style, next(0.0, 0.0));
      EXPECT_EQ(brushesMade(), made) << look.name << ", strokes of " << pixels << " px";
    }
  }
}

TEST_F(PainterlyTest, APaintingIsLikeItsPictureButNotIt) {
  Painterly style(library_);
  const hal::Image image = testPicture(kSize, 5);
  const Bytes painted = paint(style, next(image));
  const Bytes picture(image.view().planes[0].bytes.begin(), image.view().planes[0].bytes.end());
  const double difference = meanDifference(painted, picture);
  EXPECT_GT(difference, 4.0);
  EXPECT_LT(difference, 40.0);
  EXPECT_GT(variance(painted), 0.3 * variance(picture)) << "large shapes stay";
}

TEST_F(PainterlyTest, EveryViewIsPaintedAtEverySize) {
  Painterly style(library_);
  std::vector<Bytes> pictures{paint(style, next(0.0, 0.0))};
  for (const DebugViewInfo& view : style.kind().views) {
    for (const hal::FrameSize size : {hal::FrameSize{1, 1}, {1, 9}, {9, 1}, kSize}) {
      const Bytes picture = paint(style, next(0.0, 0.0, size), view.name);
      ASSERT_EQ(picture.size(), static_cast<std::size_t>(size.pixels()) * 4);
      if (size.width != kSize.width) continue;
      EXPECT_GT(variance(picture), 1.0) << view.name << " shows nothing";
      EXPECT_THAT(pictures, testing::Not(testing::Contains(picture))) << view.name;
      pictures.push_back(picture);
    }
  }
}

TEST_F(PainterlyTest, StateAdvancesTheSameWhateverIsLookedAt) {
  Painterly looked(library_);
  Painterly finished(library_);
  for (int i = 0; i < 3; ++i) {
    const scene::ArFrame frame = next(2.0 * i, 2.0);
    paint(looked, frame, looked.kind().views[static_cast<std::size_t>(i)].name);
    paint(finished, frame);
  }
  const scene::ArFrame frame = next(6.0, 2.0);
  EXPECT_EQ(paint(looked, frame), paint(finished, frame));
}

TEST_F(PainterlyTest, LooksDiffer) {
  std::vector<Bytes> painted;
  const StyleKind& info = styleKind("painterly");
  EXPECT_GE(info.looks.size(), 5U);
  const hal::Image image = testPicture(kSize, 5);
  for (const Look& look : info.looks) {
    SCOPED_TRACE(look.name);
    Painterly style(library_);
    style.setParameters(info.parametersOf(look.name));
    painted.push_back(paint(style, next(image)));
    for (std::size_t i = 3; i < painted.back().size(); i += 4) ASSERT_EQ(painted.back()[i], 255);
    for (std::size_t i = 0; i + 1 < painted.size(); ++i) {
      EXPECT_GT(meanDifference(painted[i], painted.back()), 4.0) << info.looks[i].name;
    }
  }
}

TEST_F(PainterlyTest, AStillScenesStrokesLiveOn) {
  Painterly style(library_);
  Bytes before;
  std::vector<marks::Anchor> anchors;
  double worst = 0.0;
  for (int i = 0; i < 45; ++i) {
    const Bytes now = paint(style, next(0.0, 0.0));  // still, but noisy: 2.6/255
    const std::vector<marks::Anchor> are = style.anchors()->read();
    for (std::size_t slot = 0; i > 0 && slot < are.size(); ++slot) {
      EXPECT_EQ(are[slot].isAlive(), anchors[slot].isAlive());
      if (are[slot].isAlive()) {
        EXPECT_EQ(are[slot].px, anchors[slot].px);
      }
    }
    if (i > 30) worst = std::max(worst, meanDifference(now, before));
    before = now;
    anchors = are;
  }
  RecordProperty("levels_a_frame", std::to_string(worst));
  EXPECT_LT(worst, 0.5);
}

/// Carried by the pan, the painting is its own past moved over, but for what comes in.
TEST_F(PainterlyTest, APanCarriesStrokes) {
  const auto slideOf = [&](double told) {
    restart();
    Painterly style(library_);
    style.setParameters(style.parameters().with("canvas", "0"));
    Bytes before;
    double sum = 0.0;
    for (int i = 0; i < 16; ++i) {
      const Bytes now = paint(style, next(2.0 * i, told));
      if (i >= 8) {
        const std::size_t stride = std::size_t{kSize.width} * 4;
        double difference = 0.0;
        std::size_t count = 0;
        for (std::size_t y = 20; y < 124; ++y) {
          for (std::size_t x = 80; x < stride - 80; ++x) {
            if (x % 4 == 3) continue;
            difference += std::abs(int{now[y * stride + x]} - int{before[y * stride + x + 8]});
            ++count;
          }
        }
        sum += difference / static_cast<double>(count) / 8.0;
      }
      before = now;
    }
    return sum;
  };
  const double carried = slideOf(2.0);
  const double uncarried = slideOf(0.0);
  RecordProperty("levels_a_frame", std::to_string(carried) + " of " + std::to_string(uncarried));
  EXPECT_LT(carried, 2.0);
  EXPECT_LT(carried, 0.25 * uncarried);
}

TEST_F(PainterlyTest, CoherenceGoesFromRedrawnToNeverLettingGo) {
  const auto stillOf = [&](const char* coherence) {
    restart();
    Painterly style(library_);
    style.setParameters(style.parameters().with("coherence", coherence));
    Bytes before;
    double sum = 0.0;
    for (int i = 0; i < 12; ++i) {
      const Bytes now = paint(style, next(0.0, 0.0));
      if (i >= 6) sum += meanDifference(now, before) / 6.0;
      before = now;
    }
    return sum;
  };
  const double redrawn = stillOf("0");
  const double half = stillOf("0.5");
  const double held = stillOf("1");
  RecordProperty("levels_a_frame",
                 std::to_string(redrawn) + " " + std::to_string(half) + " " + std::to_string(held));
  EXPECT_GT(redrawn, 5.0);
  EXPECT_LT(half, 0.1 * redrawn);
  EXPECT_LE(held, half);
}

TEST_F(PainterlyTest, AtNoCoherenceAFrameIsPaintedAnew) {
  Painterly style(library_);
  style.setParameters(style.parameters().with("coherence", "0"));
  paint(style, next(0.0, 0.0));
  const std::vector<marks::Anchor> first = style.anchors()->read();
  paint(style, next(0.0, 0.0));
  const std::vector<marks::Anchor> second = style.anchors()->read();
  std::set<std::uint32_t> seeds;
  for (const marks::Anchor& each : first) seeds.insert(each.isAlive() ? each.seed : 0U);
  EXPECT_GT(seeds.size(), 50U);
  for (const marks::Anchor& each : second) {
    if (each.isAlive()) {
      EXPECT_FALSE(seeds.contains(each.seed));
    }
  }
}

/// The dial holds for the field, too, or a redrawn frame's strokes would lie as the past did.
TEST_F(PainterlyTest, AtNoCoherenceTheFieldIsTheFramesOwn) {
  hal::Image upsideDown = testPicture(kSize, 5);
  std::ranges::reverse(upsideDown.plane(0));
  const hal::Image other = testPicture(kSize, 5);
  for (int y = 0; y < kSize.height; ++y) {
    for (std::size_t x = 3; x < std::size_t{kSize.width} * 4; x += 4) upsideDown.row(0, y)[x] = 255;
  }
  const auto fieldAfter = [&](const char* coherence, bool hasPast) {
    restart();
    Painterly style(library_);
    style.setParameters(style.parameters().with("coherence", coherence));
    if (hasPast) paint(style, next(upsideDown));
    return paint(style, next(other), "tensors");
  };
  EXPECT_EQ(fieldAfter("0", true), fieldAfter("0", false));
  EXPECT_NE(fieldAfter("0.5", true), fieldAfter("0.5", false)) << "the past is to count";
}

/// Strokes that are never updated keep their colours, however the image changes.
TEST_F(PainterlyTest, AtFullCoherenceThePaintingStays) {
  Painterly style(library_);
  style.setParameters(style.parameters().with("coherence", "1").with("wash", "0"));
  const Bytes first = paint(style, next(testPicture(kSize, 5)));
  Bytes last;
  hal::Image dark = testPicture(kSize, 5);
  for (auto& byte : dark.plane(0)) byte = static_cast<std::uint8_t>(byte / 2);
  for (int i = 0; i < 10; ++i) last = paint(style, next(dark));
  EXPECT_LT(meanDifference(first, last), 1.0);
  style.reset();
  EXPECT_GT(meanDifference(first, paint(style, next(dark))), 20.0);
}

TEST_F(PainterlyTest, ResetCutAndAnotherSizeStartAnew) {
  Painterly style(library_);
  Painterly other(library_);
  const hal::Image image = testPicture(kSize, 5);
  paint(style, next(image));
  for (int i = 1; i < 6; ++i) paint(style, next(5.0 * i, 5.0));
  const Bytes goneOn = paint(style, next(image));
  style.reset();
  const Bytes anew = paint(style, next(image));
  EXPECT_NE(goneOn, anew) << "the past is to count";
  EXPECT_EQ(paint(other, next(image)), anew) << "a first frame, whenever it comes";
  paint(style, next(0.0, 0.0, {64, 64}));
  EXPECT_EQ(paint(style, next(image)), anew);
  for (int i = 1; i < 4; ++i) paint(style, next(5.0 * i, 5.0));
  const scene::ArFrame cut = next(image);
  motion_.isCut = true;
  EXPECT_EQ(paint(style, cut), anew);
}

/// Another level of quality: the same strokes, painted on fewer pixels.
TEST_F(PainterlyTest, ASmallerVersionKeepsTheStrokes) {
  Painterly style(library_);
  for (int i = 0; i < 3; ++i) paint(style, next(0.0, 0.0));
  const std::vector<marks::Anchor> before = style.anchors()->read();
  scene::ArFrame frame = next(testPicture({96, 72}, 5));
  motion_.frameSize = kSize;
  frame.measuredMotion->frameScale = glm::dvec2(1.0);
  frame.fullSize = kSize;
  EXPECT_EQ(style.paint(frame, "").size(), (hal::FrameSize{96, 72}));
  const std::vector<marks::Anchor> after = style.anchors()->read();
  for (std::size_t i = 0; i < before.size(); ++i) {
    ASSERT_EQ(after[i].isAlive(), before[i].isAlive());
    if (after[i].isAlive()) {
      EXPECT_EQ(after[i].seed, before[i].seed);
    }
  }
}

TEST_F(PainterlyTest, KeepsWhatIsInFocusCrisp) {
  const hal::Image image = testPicture(kSize, 5);
  hal::Image focus({.pixelFormat = hal::PixelFormat::kRgba8, .size = kSize});
  for (int y = 0; y < kSize.height; ++y) {
    for (std::size_t x = kSize.width / 2; x < std::size_t{kSize.width}; ++x) {
      focus.row(0, y)[x * 4 + 3] = 255;  // the right half
    }
  }
  gpu::Texture normalFocus(gpu::TextureFormat::kRgba8, kSize);
  normalFocus.upload(focus.plane(0), std::size_t{kSize.width} * 4);
  Painterly style(library_);
  const Bytes without = paint(style, next(image));
  style.reset();
  scene::ArFrame frame = next(image);
  frame.normalFocus = &normalFocus;
  frame.hasFocus = true;
  const Bytes with = paint(style, frame);
  const Bytes crisp = bytesOf(picture_);
  for (std::size_t i = 0; i < with.size(); ++i) {
    const bool isInFocus = i / 4 % kSize.width >= kSize.width / 2;
    ASSERT_EQ(with[i], isInFocus ? crisp[i] : without[i]) << "byte " << i;
  }
}

TEST_F(PainterlyTest, AllocatesNothingAfterTheFirstFrameOfASize) {
  Painterly style(library_);
  for (int i = 0; i < 2; ++i) paint(style, next(0.0, 0.0));
  const scene::ArFrame frame = next(0.0, 0.0);
  EXPECT_EQ(support::allocationsIn([&] { style.paint(frame, ""); }), 0)
      << support::allocationSites();
  const scene::ArFrame other = next(0.0, 0.0, {64, 64});
  EXPECT_GT(support::allocationsIn([&] { style.paint(other, ""); }), 0) << "the counter counts";
}

/// Rings where features are, and lines from where they were: only there.
TEST_F(PainterlyTest, TheViewOfFeaturesShowsThemInTheirPlaces) {
  Painterly style(library_);
  scene::ArFrame frame = next(testPicture(kSize, 5));
  const std::vector<std::uint8_t> none = paint(style, frame, "features");
  const std::array<tracking::FeatureMotion, 2> features{
      tracking::FeatureMotion{.id = 1, .previous = {40.0F, 100.0F}, .current = {70.0F, 100.0F}},
      {.id = 2, .previous = {150.0F, 30.0F}, .current = {150.0F, 30.0F}}};
  frame = next(testPicture(kSize, 5));
  motion_.features = features;
  // Px of the captured frame lie 10 below those of the picture.
  frame.measuredMotion->frameOrigin = {0.0, 10.0};
  const std::vector<std::uint8_t> some = paint(style, frame, "features");
  const auto differs = [&](int x, int y) {
    const auto at = static_cast<std::size_t>(y * kSize.width + x) * 4;
    return std::abs(none[at] - some[at]) + std::abs(none[at + 2] - some[at + 2]) > 40;
  };
  EXPECT_TRUE(differs(55, 90)) << "the line";
  EXPECT_TRUE(differs(70, 94)) << "the ring";
  EXPECT_TRUE(differs(154, 20)) << "the other ring";
  EXPECT_FALSE(differs(55, 100));
  EXPECT_FALSE(differs(120, 60));
  EXPECT_FALSE(differs(150, 30));
}

}  // namespace
}  // namespace pleinair::styles
