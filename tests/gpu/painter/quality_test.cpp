// Levels of quality: the same painting, softer, and no cut where the level changes.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <variant>

#include <gmock/gmock.h>

#include "hal/cameras/synthetic/synthetic_camera.h"
#include "tests/gpu/painter/painter_fixture.h"

namespace pleinair {
namespace {

constexpr hal::FrameSize kSize{320, 240};
constexpr std::size_t kBlock = 16;  // px: what a block's mean differs by is no matter of softness

std::size_t lowest() {
  return qualityLevels().size() - 1;
}

/// The workbench, filmed from `first` on.
std::vector<hal::CapturedFrame> workbench(int first, int count) {
  hal::SteppedClock clock;
  hal::SyntheticCamera camera({.size = kSize}, clock);
  hal::orThrow(camera.start({}));
  std::vector<hal::CapturedFrame> frames;
  for (int i = 0; i < first + count; ++i) {
    hal::NextFrame next = camera.next(hal::kNoDeadline);
    if (i >= first) frames.push_back(std::get<hal::CapturedFrame>(std::move(next)));
  }
  return frames;
}

/// The workbench's largest tag, at 19 px; a tag smaller than 15 px would be refused.
constexpr int kTag = 3;

/// A box on one of the workbench's tags, which has a place in no world.
scene::Scene boxOnTag(int tag) {
  scene::Scene scene;
  scene.tags.push_back({.id = tag, .edgeMetres = 0.08});
  const scene::ModelSource source = scene::BoxSource{glm::dvec3(0.08)};
  scene.models.push_back(
      {.name = "box",
       .source = source,
       .model = std::make_shared<const scene::Model>(scene::modelOf(source).value()),
       .tagId = tag});
  return scene;
}

hal::Image paintedAt(Painter& painter, const hal::CapturedFrame& frame, std::size_t quality,
                     std::string view = {}) {
  PaintParameters parameters = painter.defaultParameters();
  parameters.quality = quality;
  parameters.view = std::move(view);
  const auto picture = painter.paint(frame, parameters);
  EXPECT_TRUE(picture) << picture.error().message();
  return hal::orThrow(painter.snapshot());
}

/// The mean of each channel in each block, of an RGB8 picture.
std::vector<double> blockMeans(const hal::Image& image) {
  const auto across = static_cast<std::size_t>(image.size().width) / kBlock;
  const auto down = static_cast<std::size_t>(image.size().height) / kBlock;
  std::vector<double> means(across * down * 3);
  for (std::size_t y = 0; y < down * kBlock; ++y) {
    const auto row = image.view().planes[0].bytes.subspan(y * image.view().planes[0].strideBytes);
    for (std::size_t x = 0; x < across * kBlock; ++x) {
      for (std::size_t c = 0; c < 3; ++c) {
        means[(y / kBlock * across + x / kBlock) * 3 + c] +=
            row[x * 3 + c] / static_cast<double>(kBlock * kBlock);
      }
    }
  }
  return means;
}

struct Difference {
  double shift = 0.0;    ///< of the pictures' means, in 8-bit levels
  double typical = 0.0;  ///< of blocks, root mean square
  double largest = 0.0;
};

Difference differenceOf(const hal::Image& one, const hal::Image& other) {
  const std::vector<double> a = blockMeans(one);
  const std::vector<double> b = blockMeans(other);
  Difference found;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double d = a[i] - b[i];
    found.shift += d / static_cast<double>(a.size());
    found.typical += d * d / static_cast<double>(a.size());
    found.largest = std::max(found.largest, std::abs(d));
  }
  found.typical = std::sqrt(found.typical);
  return found;
}

std::ostream& operator<<(std::ostream& out, const Difference& d) {
  return out << "shift " << d.shift << ", typical " << d.typical << ", largest " << d.largest;
}

TEST_F(PainterTest, LevelsHaveNamesAndFallingSizes) {
  const std::vector<QualityLevel> levels = qualityLevels();
  ASSERT_GE(levels.size(), 4U);
  EXPECT_EQ(levels.front().name, "full");
  EXPECT_EQ(levels.back().name, "lowest");
  Painter painter({.pictureSize = kSize, .style = "none", .qualityLevels = true});
  PaintParameters parameters = painter.defaultParameters();
  int last = kSize.width + 1;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    parameters.quality = i;
    const auto picture = hal::orThrow(painter.paint(testFrame(0, kSize), parameters));
    EXPECT_EQ(picture.quality, i);
    EXPECT_LT(picture.size.width, last);
    EXPECT_EQ(hal::orThrow(painter.snapshot()).size(), kSize);
    EXPECT_EQ(hal::orThrow(painter.cameraSnapshot()).size(), kSize);
    last = picture.size.width;
  }
}

TEST_F(PainterTest, RefusesLevelsThatItHasNot) {
  Painter plain({.pictureSize = {96, 64}, .style = "none"});
  Painter levelled({.pictureSize = {96, 64}, .style = "none", .qualityLevels = true});
  PaintParameters parameters = plain.defaultParameters();
  parameters.quality = 1;
  const auto without = plain.paint(testFrame(0), parameters);
  ASSERT_FALSE(without);
  EXPECT_EQ(without.error().kind, hal::ErrorKind::kInvalidArgument);
  EXPECT_THAT(without.error().message(), testing::HasSubstr("made without quality levels"));
  parameters.quality = qualityLevels().size();
  const auto beyond = levelled.paint(testFrame(0), parameters);
  ASSERT_FALSE(beyond);
  EXPECT_THAT(beyond.error().message(), testing::HasSubstr(std::to_string(lowest()) + " (lowest)"));
  parameters.quality = 0;
  EXPECT_TRUE(plain.paint(testFrame(0), parameters));
}

TEST_F(PainterTest, EveryLevelPaintsTheTiniestPictures) {
  for (const hal::FrameSize size : {hal::FrameSize{1, 1}, {3, 2}, {1, 40}}) {
    Painter painter({.pictureSize = size, .qualityLevels = true});
    for (std::size_t i = 0; i <= lowest(); ++i) {
      EXPECT_EQ(paintedAt(painter, testFrame(static_cast<int>(i)), i).size(), size);
    }
  }
}

/// The camera's image and the models lie at the same places as at full size, to a fraction of a px.
TEST_F(PainterTest, LevelsShowTheSamePlaces) {
  const auto frames = workbench(0, 1);
  for (const hal::FrameSize size : {kSize, hal::FrameSize{306, 171}}) {
    Painter painter(
        {.pictureSize = size, .scene = boxOnTag(kTag), .style = "none", .qualityLevels = true});
    const hal::Image full = paintedAt(painter, frames[0], 0, "ar");
    const hal::Image without = paintedAt(painter, frames[0], 0, "camera");
    EXPECT_GT(differenceOf(full, without).largest, 10.0) << "the box is not there";
    for (std::size_t i = 1; i <= lowest(); ++i) {
      painter.reset();  // the same frame again
      const Difference found = differenceOf(paintedAt(painter, frames[0], i, "ar"), full);
      EXPECT_LT(std::abs(found.shift), 0.5) << i << ": " << found;
      EXPECT_LT(found.typical, 1.0) << i << ": " << found;
    }
  }
}

TEST_F(PainterTest, LevelsAreTheSamePainting) {
  const auto frames = workbench(0, 4);
  Painter full({.pictureSize = kSize, .scene = boxOnTag(kTag)});
  hal::Image wanted;
  for (const hal::CapturedFrame& frame : frames) wanted = paintedAt(full, frame, 0);
  for (std::size_t i = 1; i <= lowest(); ++i) {
    Painter painter({.pictureSize = kSize, .scene = boxOnTag(kTag), .qualityLevels = true});
    hal::Image found;
    for (const hal::CapturedFrame& frame : frames) found = paintedAt(painter, frame, i);
    const Difference difference = differenceOf(found, wanted);
    EXPECT_LT(std::abs(difference.shift), 2.0) << i << ": " << difference;
    EXPECT_LT(difference.typical, 4.5) << i << ": " << difference;
  }
}

/// The frame after a switch differs from what would have come without by no more than the levels
/// do.
TEST_F(PainterTest, AChangeOfLevelIsNoCut) {
  const auto frames = workbench(0, 8);
  Painter steady({.pictureSize = kSize, .scene = boxOnTag(kTag)});
  Painter changing({.pictureSize = kSize, .scene = boxOnTag(kTag), .qualityLevels = true});
  const std::array<std::size_t, 8> levels{0, 0, 1, 3, 2, 3, 0, 3};
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const hal::Image wanted = paintedAt(steady, frames[i], 0);
    const Difference found = differenceOf(paintedAt(changing, frames[i], levels[i]), wanted);
    EXPECT_LT(std::abs(found.shift), 2.0) << i << ": " << found;
    EXPECT_LT(found.typical, levels[i] == 0 ? 1.0 : 4.5) << i << ": " << found;
  }
}

/// The paper goes on where it was: a style that forgot would lay it anew.
TEST_F(PainterTest, ComesBackToThePaintingItLeft) {
  const auto frames = workbench(0, 8);
  Painter steady({.pictureSize = kSize});
  Painter changing({.pictureSize = kSize, .qualityLevels = true});
  Painter fresh({.pictureSize = kSize});
  const auto rms = [](const hal::Image& one, const hal::Image& other) {
    const auto a = bytesOf(one);
    const auto b = bytesOf(other);
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += std::pow(1.0 * a[i] - b[i], 2);
    return std::sqrt(sum / static_cast<double>(a.size()));
  };
  hal::Image wanted;
  hal::Image back;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    wanted = paintedAt(steady, frames[i], 0);
    back = paintedAt(changing, frames[i], i == 6 ? 2 : 0);
  }
  const hal::Image anew = paintedAt(fresh, frames.back(), 0);
  EXPECT_LT(rms(back, wanted), 0.5 * rms(anew, wanted));
}

}  // namespace
}  // namespace pleinair
