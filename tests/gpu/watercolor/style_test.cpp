// The style as a whole: what it promises about time, sizes and independence.
#include <algorithm>
#include <random>

#include <gmock/gmock.h>

#include "hal/error.h"
#include "pipeline/styles/watercolor/watercolor.h"
#include "tests/gpu/watercolor/watercolor_fixture.h"
#include "tests/support/allocation_count.h"

namespace pleinair::styles {
namespace {

using support::readRgba8;
using support::textureOf;

std::vector<std::uint8_t> bytesOf(const gpu::Texture& texture) {
  hal::Image image = readRgba8(texture);
  return {image.plane(0).begin(), image.plane(0).end()};
}

class WatercolorTest : public StyleTest {
 protected:
  static std::vector<marks::BinnedPoint> pointsOf(const Watercolor& style) {
    return support::readBuffer<marks::BinnedPoint>(style.inner().tiler->points());
  }
  static std::vector<glm::vec2> offsetsOf(const Watercolor& style) {
    std::vector<glm::vec2> offsets;
    for (const CellSeed& seed : support::readBuffer<CellSeed>(style.inner().tiler->seeds())) {
      offsets.push_back(seed.offset);
    }
    return offsets;
  }

  /// The pictures of a camera that moves over the test picture.
  std::vector<std::uint8_t> paintFrame(Style& style, int number, hal::FrameSize size = {120, 90},
                                       std::string_view view = {}) {
    const gpu::Texture picture = textureOf(testPicture(size, 5, number * 3.0).view());
    return bytesOf(style.paint(frameOf(picture, number), view));
  }
};

TEST_F(WatercolorTest, GivesTheSamePicturesOnEveryRunAndBesideAnother) {
  Watercolor first(library_);
  Watercolor second(library_);
  second.setParameters(second.parameters().with("seed", "9").with("cell_size", "12"));
  std::vector<std::vector<std::uint8_t>> alone;
  alone.reserve(4);
  for (int i = 0; i < 4; ++i) alone.push_back(paintFrame(first, i));
  first.reset();
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(paintFrame(first, i), alone[static_cast<std::size_t>(i)]) << "frame " << i;
    EXPECT_NE(paintFrame(second, i), alone[static_cast<std::size_t>(i)]);
  }
}

TEST_F(WatercolorTest, AnotherSizeStartsAnew) {
  Watercolor style(library_);
  const auto fresh = paintFrame(style, 0);
  for (int i = 1; i < 4; ++i) paintFrame(style, i);
  EXPECT_NE(paintFrame(style, 0), fresh) << "the past is to count while the size stays";
  paintFrame(style, 0, {64, 64});
  EXPECT_EQ(paintFrame(style, 0), fresh);
}

/// Another level of quality: the cells go on, seeds in the new size's px.
TEST_F(WatercolorTest, ASmallerVersionKeepsTheSeeds) {
  Watercolor style(library_);
  // The pictures move without a known motion of the camera: all of them would be movers.
  style.setParameters(style.parameters().with("movers", "false"));
  for (int i = 0; i < 4; ++i) paintFrame(style, i);
  const auto before = pointsOf(style);
  const auto seedsBefore = offsetsOf(style);
  const gpu::Texture smaller = textureOf(testPicture({66, 50}, 5, 9.0).view());
  scene::ArFrame frame = frameOf(smaller, 3);  // no time passes
  frame.fullSize = hal::FrameSize{120, 90};
  style.paint(frame, "");
  const auto after = pointsOf(style);
  ASSERT_EQ(after.size(), before.size());
  const auto seeds = offsetsOf(style);
  for (std::size_t i = 0; i < before.size(); ++i) {
    ASSERT_EQ(after[i].slot, before[i].slot) << i;
    ASSERT_EQ(seeds[i], seedsBefore[i]) << i;
  }
  paintFrame(style, 3);
  const auto back = pointsOf(style);
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (before[i].slot == marks::BinnedPoint::kNone) continue;
    EXPECT_NEAR(after[i].at.x, back[i].at.x * 66.0 / 120.0, 1.0) << i;
    EXPECT_NEAR(after[i].at.y, back[i].at.y * 50.0 / 90.0, 1.0) << i;
  }
}

TEST_F(WatercolorTest, KeepsWhatIsInFocusCrisp) {
  constexpr hal::FrameSize kSize{96, 64};
  const hal::Image image = testPicture(kSize, 5, 0.0);
  const gpu::Texture picture = textureOf(image.view());
  hal::Image focus({.pixelFormat = hal::PixelFormat::kRgba8, .size = kSize});
  for (int y = 0; y < kSize.height; ++y) {
    for (std::size_t x = kSize.width / 2; x < std::size_t{kSize.width}; ++x) {
      focus.row(0, y)[x * 4 + 3] = 255;  // the right half
    }
  }
  gpu::Texture normalFocus(gpu::TextureFormat::kRgba8, kSize);
  normalFocus.upload(focus.plane(0), std::size_t{kSize.width} * 4);

  Watercolor style(library_);
  style.setParameters(style.parameters().with("grain", "0"));
  scene::ArFrame frame = frameOf(picture, 0);
  const std::vector<std::uint8_t> without = bytesOf(style.paint(frame, {}));
  style.reset();
  frame.normalFocus = &normalFocus;
  frame.hasFocus = true;
  const std::vector<std::uint8_t> with = bytesOf(style.paint(frame, {}));
  const std::vector<std::uint8_t> crisp = bytesOf(picture);
  for (std::size_t i = 0; i < with.size(); ++i) {
    const bool isInFocus = i / 4 % kSize.width >= kSize.width / 2;
    ASSERT_EQ(with[i], isInFocus ? crisp[i] : without[i]) << "byte " << i;
  }
  EXPECT_NE(without, crisp);
}

TEST_F(WatercolorTest, StateAdvancesTheSameWhateverIsLookedAt) {
  Watercolor looked(library_);
  Watercolor finished(library_);
  for (int i = 0; i < 3; ++i) {
    paintFrame(looked, i, {120, 90}, "retiling");
    paintFrame(finished, i);
  }
  EXPECT_EQ(paintFrame(looked, 3), paintFrame(finished, 3));
}

TEST_F(WatercolorTest, EveryViewIsPaintedAtEverySize) {
  Watercolor style(library_);
  std::vector<std::vector<std::uint8_t>> pictures{paintFrame(style, 0)};
  for (const DebugViewInfo& view : style.kind().views) {
    for (const hal::FrameSize size : {hal::FrameSize{1, 1}, {1, 9}, {9, 1}, {120, 90}}) {
      const auto picture = paintFrame(style, 0, size, view.name);
      for (std::size_t i = 3; i < picture.size(); i += 4) ASSERT_EQ(picture[i], 255) << view.name;
      if (size.width == 120) {
        EXPECT_THAT(pictures, testing::Not(testing::Contains(picture))) << view.name;
        pictures.push_back(picture);
      }
    }
  }
}

TEST_F(WatercolorTest, StillSceneComesToRest) {
  Watercolor style(library_);
  const gpu::Texture picture = textureOf(testPicture({120, 90}, 5).view());
  for (int i = 0; i < 250; ++i) style.paint(frameOf(picture, i), "");
  const auto settled = bytesOf(style.paint(frameOf(picture, 250), ""));
  EXPECT_EQ(bytesOf(style.paint(frameOf(picture, 251), "")), settled);
}

TEST_F(WatercolorTest, TimeThatStandsOrRunsBackMovesNoSeed) {
  Watercolor style(library_);
  style.setParameters(style.parameters().with("retile_rest", "0"));
  paintFrame(style, 5);
  const auto at5 = offsetsOf(style);
  const gpu::Texture other = textureOf(testPicture({120, 90}, 5, 9.0).view());
  style.paint(frameOf(other, 5), "");
  EXPECT_EQ(offsetsOf(style), at5);
  style.paint(frameOf(other, 2), "");
  EXPECT_EQ(offsetsOf(style), at5);
  style.paint(frameOf(other, 4), "");
  EXPECT_NE(offsetsOf(style), at5);
}

/// A camera that stands still before a scene, with sensor noise (σ = 2/255).
class StillCameraTest : public WatercolorTest {
 protected:
  hal::Image paintNext(Watercolor& style) {
    hal::Image image = testPicture(kSize, 5);
    std::mt19937 random(number_);
    std::normal_distribution<double> noise(0.0, 2.0);
    for (std::uint8_t& value : image.plane(0)) {
      value = static_cast<std::uint8_t>(std::clamp(value + noise(random), 0.0, 255.0));
    }
    const gpu::Texture picture = textureOf(image.view());
    tracking::ImageMotion motion;
    const scene::ArFrame frame = followed(picture, static_cast<int>(number_++), {0.0, 0.0}, motion);
    return readRgba8(style.paint(frame, {}));
  }

  static constexpr hal::FrameSize kSize{160, 120};
  unsigned number_ = 0;
};

TEST_F(StillCameraTest, NoiseMovesNoSeedAfterASecond) {
  Watercolor style(library_);
  for (int i = 0; i < 25; ++i) paintNext(style);
  const auto settled = offsetsOf(style);
  for (int i = 0; i < 40; ++i) {
    paintNext(style);
    ASSERT_EQ(style.inner().tiler->readMoving(), 0U) << "frame " << i;
  }
  EXPECT_EQ(offsetsOf(style), settled) << "to the bit";
}

TEST_F(StillCameraTest, ThePaintingIsStillerThanThePicture) {
  Watercolor style(library_);
  for (int i = 0; i < 25; ++i) paintNext(style);
  hal::Image before = paintNext(style);
  hal::Image after = paintNext(style);
  int most = 0;
  double sum = 0.0;
  for (std::size_t i = 0; i < before.plane(0).size(); ++i) {
    const int change = std::abs(int{before.plane(0)[i]} - int{after.plane(0)[i]});
    most = std::max(most, change);
    sum += change;
  }
  EXPECT_LT(sum / static_cast<double>(kSize.pixels() * 3), 0.2);  // the picture's is 2.3
  EXPECT_LT(most, 24);
}

/// The parts of the pixels whose cell is that of the pixel `by` before.
double carriedPart(const std::vector<std::uint32_t>& then, const std::vector<std::uint32_t>& now,
                   hal::FrameSize size, glm::ivec2 by) {
  int same = 0;
  int all = 0;
  for (int y = 16; y < size.height - 16; ++y) {
    for (int x = 16; x < size.width - 16; ++x) {
      const auto at = [&](int u, int v) { return static_cast<std::size_t>(v * size.width + u); };
      same += ((then[at(x - by.x, y - by.y)] ^ now[at(x, y)]) & 0x3FFFFFU) == 0 ? 1 : 0;
      ++all;
    }
  }
  return static_cast<double>(same) / all;
}

TEST_F(WatercolorTest, APanCarriesTheCells) {
  constexpr hal::FrameSize kSize{160, 120};
  constexpr glm::ivec2 kBy{-3, 1};
  hal::Image wide = testPicture({320, 240}, 5);
  Watercolor style(library_);
  std::vector<std::uint32_t> then;
  for (int i = 0; i < 12; ++i) {
    hal::Image image({.pixelFormat = hal::PixelFormat::kRgba8, .size = kSize});
    for (int y = 0; y < kSize.height; ++y) {
      const auto row =
          wide.row(0, 40 + y - kBy.y * i).subspan(static_cast<std::size_t>(40 - kBy.x * i) * 4);
      std::copy_n(row.begin(), image.row(0, y).size(), image.row(0, y).begin());
    }
    const gpu::Texture picture = textureOf(image.view());
    tracking::ImageMotion motion;
    style.paint(followed(picture, i, kBy, motion), {});
    const auto now = support::readR32ui(*style.inner().tiling);
    if (i > 6) {
      EXPECT_GT(carriedPart(then, now, kSize, kBy), 0.95) << i;
      EXPECT_LT(carriedPart(then, now, kSize, {0, 0}), 0.8) << "cells that stay with the screen";
    }
    then = now;
  }
}

TEST_F(WatercolorTest, ACutStartsAnew) {
  Watercolor style(library_);
  const gpu::Texture one = textureOf(testPicture({120, 90}, 5).view());
  const gpu::Texture other = textureOf(testPicture({120, 90}, 6, 50.0).view());
  tracking::ImageMotion motion;
  for (int i = 0; i < 5; ++i) style.paint(followed(one, i, {0.0, 0.0}, motion), {});
  scene::ArFrame cut = followed(other, 5, {0.0, 0.0}, motion);
  motion.isCut = true;
  style.paint(cut, {});
  // Nothing of the old scene goes on.
  EXPECT_EQ(style.inner().tiler->readMoving(), 0U);
  for (const CellSeed& seed : support::readBuffer<CellSeed>(style.inner().tiler->seeds())) {
    ASSERT_TRUE(!seed.isLiving() || seed.parent == 0);
  }
  const std::vector<float> filtered = support::readRgba32f(*style.inner().filtered);
  for (std::size_t i = 3; i < filtered.size(); i += 4) ASSERT_EQ(filtered[i], 1.0F);
}

/// A born cell begins with the colours of the one that it is born in.
TEST_F(WatercolorTest, NewbornCellsAreOfTheirParentsColours) {
  constexpr hal::FrameSize kSize{160, 120};
  Watercolor style(library_);
  int born = 0;
  hal::Image then;
  for (int i = 0; i < 12; ++i) {
    const gpu::Texture picture = textureOf(testPicture(kSize, 5, 4.0 * i).view());
    tracking::ImageMotion motion;
    style.paint(followed(picture, i, {-4.0, 0.0}, motion), {});
    hal::Image washes = readRgba8(*style.inner().darkWash);
    const auto seeds = support::readBuffer<CellSeed>(style.inner().tiler->seeds());
    const auto words = support::readR32ui(*style.inner().tiling);
    for (std::size_t slot = 0; i > 0 && slot < seeds.size(); ++slot) {
      if ((seeds[slot].state & CellSeed::kBorn) == 0 || seeds[slot].parent == 0) continue;
      const auto isOurs = [&](std::uint32_t word) { return (word & 0x3FFFFFU) == slot; };
      if (std::ranges::any_of(words, isOurs)) continue;  // it has pixels of its own by now
      ++born;
      const std::size_t parent = seeds[slot].parent - 1;
      for (std::size_t c = 0; c < 3; ++c) {
        ASSERT_EQ(washes.plane(0)[slot * 4 + c], then.plane(0)[parent * 4 + c]) << i << " " << slot;
      }
    }
    then = std::move(washes);
  }
  EXPECT_GT(born, 10);
}

TEST_F(WatercolorTest, AllocatesNothingAfterTheFirstFrameOfASize) {
  Watercolor style(library_);
  const gpu::Texture picture = textureOf(testPicture({120, 90}, 5).view());
  style.paint(frameOf(picture, 0), "");
  EXPECT_EQ(support::allocationsIn([&] { style.paint(frameOf(picture, 1), ""); }), 0);
  const gpu::Texture other = textureOf(testPicture({64, 64}, 5).view());
  EXPECT_GT(support::allocationsIn([&] { style.paint(frameOf(other, 2), ""); }), 0)
      << "the counter counts";
}

TEST_F(WatercolorTest, SilhouettesOfObjectsAreEdges) {
  hal::Image grey({.pixelFormat = hal::PixelFormat::kRgba8, .size = {64, 48}});
  std::ranges::fill(grey.plane(0), std::uint8_t{128});
  const gpu::Texture picture = textureOf(grey.view());
  std::vector<std::uint32_t> ids(std::size_t{64} * 48);
  for (std::size_t y = 10; y < 30; ++y) {
    // Triangles of one object make no edge between them.
    for (std::size_t x = 20; x < 40; ++x) {
      ids[y * 64 + x] = (3U << scene::kTriangleBits) | static_cast<std::uint32_t>(x & 1U);
    }
  }
  gpu::Texture idTexture(gpu::TextureFormat::kR32ui, {64, 48});
  idTexture.upload({reinterpret_cast<const std::uint8_t*>(ids.data()), ids.size() * 4}, 256);
  gpu::Texture barycentrics(gpu::TextureFormat::kR32ui, {64, 48});
  const std::vector<std::uint8_t> zeros(ids.size() * 4);
  barycentrics.upload(zeros, 256);
  scene::ArFrame frame = frameOf(picture);
  frame.ids = &idTexture;
  frame.barycentrics = &barycentrics;
  frame.forms = &barycentrics;
  frame.hasObjects = true;
  Watercolor style(library_);
  style.paint(frame, "");
  const auto words = support::readR32ui(*style.inner().tiling);
  for (std::size_t y = 0; y < 48; ++y) {
    for (std::size_t x = 0; x < 64; ++x) {
      const auto inside = [](std::size_t u, std::size_t v) {
        return u >= 20 && u < 40 && v >= 10 && v < 30;
      };
      const bool wanted = (x > 0 && inside(x - 1, y) != inside(x + 1, y)) ||
                          (y > 0 && inside(x, y - 1) != inside(x, y + 1));
      ASSERT_EQ((words[y * 64 + x] & 0x400000U) != 0, wanted) << x << "," << y;
    }
  }
}

TEST_F(WatercolorTest, MakesStylesByNameAndRefusesOthersWithTheList) {
  for (const StyleKind* kind : styleKinds()) {
    EXPECT_EQ(&makeStyle(kind->name, library_)->kind(), kind);
  }
  try {
    makeStyle("watercolour", library_);
    FAIL() << "made it";
  } catch (const hal::Failure& error) {
    EXPECT_EQ(error.error().kind, hal::ErrorKind::kInvalidArgument);
    EXPECT_THAT(error.what(), testing::HasSubstr("watercolour"));
    EXPECT_THAT(error.what(), testing::HasSubstr("watercolor, painterly, hatching, none"));
  }
  EXPECT_EQ(makeStyle("watercolor", library_)->kind().name, "watercolor");
}

TEST_F(WatercolorTest, TheStyleNoneHandsTheFrameThrough) {
  const auto style = makeStyle("none", library_);
  const gpu::Texture picture = textureOf(testPicture({9, 7}, 5).view());
  EXPECT_EQ(&style->paint(frameOf(picture), ""), &picture);
}

}  // namespace
}  // namespace pleinair::styles
