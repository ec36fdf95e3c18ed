// Paint that does not run over the boundary of what its stroke is of: where that is, against the
// CPU, and what comes of it.
#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <random>
#include <span>
#include <utility>
#include <vector>

#include <gmock/gmock.h>

#include "pipeline/gpu/render_target.h"
#include "pipeline/marks/movers/layer_textures.h"
#include "pipeline/marks/movers/motion_layers.h"
#include "pipeline/marks/tensors/segment_map.h"
#include "pipeline/styles/strokes/stroke_borders.h"
#include "tests/gpu/marks/wall_and_disc.h"
#include "tests/gpu/painterly/painterly_fixture.h"
#include "tests/gpu/painterly/spill.h"
#include "tests/oracles/stroke_oracle.h"

namespace pleinair::styles {
namespace {

// As marks/strokes/shaders/stroke_border.glsl packs them.
constexpr unsigned kLabelBits = 13;
constexpr std::uint32_t kLabelMask = (1U << kLabelBits) - 1U;
constexpr double kShareStep = 0.5 / 31.0 + 1e-6;
double shareOf(std::uint32_t border) {
  return (border >> 26U & 31U) / 31.0;
}

class ClipTest : public PainterlyTest {
 protected:
  void setIds(hal::FrameSize size, const std::function<std::uint32_t(int, int)>& objectAt) {
    std::vector<std::uint32_t> ids;
    std::vector<std::uint32_t> forms;  // labels without directions
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) {
        const std::uint32_t object = objectAt(x, y);
        ids.push_back(object << scene::kTriangleBits | (object == 0 ? 0U : 7U));
        forms.push_back(object < scene::kRealObject ? object : 0U);
      }
    }
    const std::size_t stride = static_cast<std::size_t>(size.width) * 4;
    ids_ = gpu::Texture(gpu::TextureFormat::kR32ui, size);
    ids_.upload({reinterpret_cast<const std::uint8_t*>(ids.data()), ids.size() * 4}, stride);
    forms_ = gpu::Texture(gpu::TextureFormat::kR32ui, size);
    forms_.upload({reinterpret_cast<const std::uint8_t*>(forms.data()), forms.size() * 4}, stride);
    zeros_ = gpu::Texture(gpu::TextureFormat::kR32ui, size);
    zeros_.upload(std::vector<std::uint8_t>(ids.size() * 4), stride);
  }

  /// In use, without segments.
  gpu::Program& bordersProgram() {
    program_ = library_.fragmentPass("pipeline/styles/strokes/shaders/borders.frag");
    marks::SegmentMap::bind(program_.use(), nullptr, forms_);
    return program_.texture("picture", forms_).texture("before", forms_).set("isHeld", 0);
  }

  gpu::Texture ids_;
  gpu::Texture forms_;
  gpu::Texture zeros_;
  gpu::Program program_;
};

TEST_F(ClipTest, BordersAreTheOracles) {
  constexpr hal::FrameSize kSmall{23, 17};
  std::mt19937 random(5);
  const std::uint32_t real = scene::kRealObject + 3U;
  const std::array<std::uint32_t, 5> objects{0, 1, 300, 511, real};
  std::vector<std::uint32_t> is;
  for (int i = 0; i < kSmall.width * kSmall.height; ++i) {
    is.push_back(random() % 3U == 0U ? objects.at(random() % 5U) : objects.at(1));
  }
  const auto at = [&](int x, int y) {
    x = std::clamp(x, 0, kSmall.width - 1);
    y = std::clamp(y, 0, kSmall.height - 1);
    return is[static_cast<std::size_t>(y * kSmall.width + x)];
  };
  setIds(kSmall, at);
  const auto seen = [&](int x, int y) { return at(x, y) == real ? 0U : at(x, y); };
  const gpu::Texture borders(gpu::TextureFormat::kR32ui, kSmall);
  const gpu::Texture noDepth(gpu::TextureFormat::kR32f, {1, 1});
  const marks::LayerTextures layerTextures;
  bordersProgram()
      .texture("forms", forms_)
      .texture("depth", noDepth)
      .set("depthRange", glm::vec2(0.0F))
      .texture("moverShares", layerTextures.sharesOf(nullptr))
      .set("hasObjects", 1)
      .set("objectBounds", glm::vec4(0, 0, kSmall.width, kSmall.height))
      .set("size", glm::vec2(kSmall.width, kSmall.height))
      .set("pixelsOfFull", glm::vec2(1.0F))
      .drawFullscreen(gpu::RenderTarget({&borders}));
  const std::vector<std::uint32_t> found = support::readR32ui(borders);
  int others = 0;
  for (int y = 0; y < kSmall.height; ++y) {
    for (int x = 0; x < kSmall.width; ++x) {
      const std::uint32_t border = found[static_cast<std::size_t>(y * kSmall.width + x)];
      const std::uint32_t own = border & kLabelMask;
      const std::uint32_t other = border >> kLabelBits & kLabelMask;
      EXPECT_EQ(own, seen(x, y));
      std::vector<bool> its;
      bool isNear = false;
      for (int i = 0; i < 9; ++i) {
        const std::uint32_t there = seen(x + i % 3 - 1, y + i / 3 - 1);
        its.push_back(there == own);
        isNear = isNear || there == other;
      }
      EXPECT_NEAR(shareOf(border), oracles::paintableShare(its), kShareStep);
      EXPECT_TRUE(isNear);
      others += other != own ? 1 : 0;
      EXPECT_EQ(other == own, std::ranges::all_of(its, [](bool each) { return each; }));
    }
  }
  EXPECT_GT(others, 100);
}

/// Where trunk and limb meet, strokes of both fade out beyond the border; where the limb lies
/// before the trunk, they are clipped.
TEST_F(ClipTest, AJointIsOpenUnlessDepthStepsThere) {
  constexpr hal::FrameSize kSmall{64, 9};
  constexpr int kEdge = 32;
  constexpr std::uint32_t kOnLimb = 1U << 29U;
  constexpr std::uint32_t kAtJoint = 1U << 30U;
  constexpr std::uint32_t kOpen = 1U << 31U;
  constexpr float kNear = 0.1F;
  constexpr float kFar = 10.0F;
  const auto bordersOf = [&](std::uint32_t marks, float step) {
    std::vector<std::uint32_t> forms;
    std::vector<float> windows;
    for (int y = 0; y < kSmall.height; ++y) {
      for (int x = 0; x < kSmall.width; ++x) {
        const bool isLimb = x >= kEdge;
        forms.push_back((isLimb ? 2U | kOnLimb : 1U) | marks);
        const float metres = 1.0F + 0.004F * static_cast<float>(x) - (isLimb ? step : 0.0F);
        windows.push_back((kFar - kNear * kFar / metres) / (kFar - kNear));
      }
    }
    const auto bytesOf = [](const auto& values) {
      return std::span(reinterpret_cast<const std::uint8_t*>(values.data()), values.size() * 4);
    };
    forms_ = gpu::Texture(gpu::TextureFormat::kR32ui, kSmall);
    forms_.upload(bytesOf(forms), std::size_t{kSmall.width} * 4);
    gpu::Texture depth(gpu::TextureFormat::kR32f, kSmall);
    depth.upload(bytesOf(windows), std::size_t{kSmall.width} * 4);
    const gpu::Texture borders(gpu::TextureFormat::kR32ui, kSmall);
    const marks::LayerTextures layerTextures;
    bordersProgram()
        .texture("forms", forms_)
        .texture("depth", depth)
        .set("depthRange", glm::vec2(kNear, kFar))
        .texture("moverShares", layerTextures.sharesOf(nullptr))
        .set("hasObjects", 1)
        .set("objectBounds", glm::vec4(0, 0, kSmall.width, kSmall.height))
        .set("size", glm::vec2(kSmall.width, kSmall.height))
        .set("pixelsOfFull", glm::vec2(1.0F))
        .drawFullscreen(gpu::RenderTarget({&borders}));
    const std::vector<std::uint32_t> all = support::readR32ui(borders);
    return std::vector<std::uint32_t>(all.begin() + 4 * kSmall.width,
                                      all.begin() + 5 * kSmall.width);
  };
  const std::vector<std::uint32_t> open = bordersOf(kAtJoint, 0.0F);
  for (int x = 0; x < kSmall.width; ++x) {
    const std::uint32_t border = open[static_cast<std::size_t>(x)];
    const int away = x < kEdge ? kEdge - x : x - kEdge + 1;
    EXPECT_EQ(border & kLabelMask, x < kEdge ? 1U : 2U);
    // Every second pixel is looked at.
    EXPECT_TRUE(away <= 16 || (border & kOpen) == 0U) << x;
    if (away >= 14) continue;
    EXPECT_NE(border & kOpen, 0U) << x;
    EXPECT_EQ(border >> kLabelBits & kLabelMask, x < kEdge ? 2U : 1U) << x;
    EXPECT_NEAR(shareOf(border), 1.0 - away / 16.0, 0.09) << x;
  }
  for (const auto& [marks, step] : {std::pair{kAtJoint, 0.1F}, {0U, 0.0F}}) {
    const std::vector<std::uint32_t> closed = bordersOf(marks, step);
    for (int x = 0; x < kSmall.width; ++x) {
      const std::uint32_t border = closed[static_cast<std::size_t>(x)];
      EXPECT_EQ(border & kOpen, 0U) << x << " step " << step;
      EXPECT_EQ((border >> kLabelBits & kLabelMask) != (border & kLabelMask),
                x == kEdge || x == kEdge - 1)
          << x;
    }
  }
}

/// The borders of movers, from random labels. The oracle samples labels as a LINEAR texture does,
/// one texel for 2x2 px of the full image.
class MoverBordersTest : public ClipTest {
 protected:
  static constexpr hal::FrameSize kSmall{23, 17};
  static constexpr std::uint32_t kMover = 4095;  // surface_form.glsl's

  void setLabels(hal::FrameSize size) {
    std::mt19937 random(7);
    labelSize_ = size;
    isMover_.clear();
    std::vector<std::uint8_t> halves;
    for (int i = 0; i < size.width * size.height; ++i) {
      isMover_.push_back(random() % 3U == 0U);
      const std::uint8_t high = isMover_.back() ? 0x3C : 0;  // 1 as a half float
      for (const std::uint8_t byte :
           {std::uint8_t{0}, high, std::uint8_t{0}, std::uint8_t{0}, std::uint8_t{0},
            std::uint8_t{0}, std::uint8_t{0}, std::uint8_t{0}}) {
        halves.push_back(byte);
      }
    }
    labels_ = gpu::Texture(gpu::TextureFormat::kRgba16f, size, gpu::TextureFilter::kLinear);
    labels_.upload(halves, static_cast<std::size_t>(size.width) * 8);
  }

  double labelAt(int x, int y) const {
    x = std::clamp(x, 0, labelSize_.width - 1);
    y = std::clamp(y, 0, labelSize_.height - 1);
    return isMover_[static_cast<std::size_t>(y * labelSize_.width + x)] ? 1.0 : 0.0;
  }
  /// The label at a pixel of the frame.
  double moverAt(int x, int y, double pixelsOfFull) const {
    const double u = (x + 0.5) / pixelsOfFull / marks::MotionLayers::kCellPixels - 0.5;
    const double v = (y + 0.5) / pixelsOfFull / marks::MotionLayers::kCellPixels - 0.5;
    const int left = static_cast<int>(std::floor(u));
    const int top = static_cast<int>(std::floor(v));
    return std::lerp(std::lerp(labelAt(left, top), labelAt(left + 1, top), u - left),
                     std::lerp(labelAt(left, top + 1), labelAt(left + 1, top + 1), u - left),
                     v - top);
  }

  gpu::Texture labels_;
  hal::FrameSize labelSize_;
  std::vector<bool> isMover_;
};

TEST_F(MoverBordersTest, AreTheOracles) {
  constexpr std::uint32_t kModel = 3;
  struct Case {
    bool hasObjects;
    double pixelsOfFull;
    hal::FrameSize labels;
  };
  for (const Case& each : {Case{false, 1.0, {12, 9}}, Case{true, 1.0, {12, 9}},
                           Case{false, 0.5, {23, 17}}, Case{true, 0.5, {23, 17}}}) {
    SCOPED_TRACE(testing::Message() << each.hasObjects << " " << each.pixelsOfFull);
    setLabels(each.labels);
    const auto isModel = [&](int x, int y) { return each.hasObjects && x > 8 && x < 15 && y > 5; };
    setIds(kSmall, [&](int x, int y) { return isModel(x, y) ? kModel : 0U; });
    const auto seen = [&](int x, int y) -> std::uint32_t {
      x = std::clamp(x, 0, kSmall.width - 1);
      y = std::clamp(y, 0, kSmall.height - 1);
      if (isModel(x, y)) return kModel;
      return moverAt(x, y, each.pixelsOfFull) > 0.5 ? kMover : 0U;
    };
    const gpu::Texture borders(gpu::TextureFormat::kR32ui, kSmall);
    const gpu::Texture noDepth(gpu::TextureFormat::kR32f, {1, 1});
    bordersProgram()
        .texture("forms", forms_)
        .texture("depth", noDepth)
        .set("depthRange", glm::vec2(0.0F))
        .texture("moverShares", labels_)
        .set("hasObjects", each.hasObjects ? 1 : 0)
        .set("objectBounds", glm::vec4(9, 6, 15, kSmall.height))
        .set("size", glm::vec2(kSmall.width, kSmall.height))
        .set("pixelsOfFull", glm::vec2(static_cast<float>(each.pixelsOfFull)))
        .drawFullscreen(gpu::RenderTarget({&borders}));
    const std::vector<std::uint32_t> found = support::readR32ui(borders);
    int ofMovers = 0;
    int clipped = 0;
    for (int y = 0; y < kSmall.height; ++y) {
      for (int x = 0; x < kSmall.width; ++x) {
        const std::uint32_t border = found[static_cast<std::size_t>(y * kSmall.width + x)];
        const std::uint32_t own = seen(x, y);
        std::uint32_t other = own;
        std::vector<bool> its;
        for (int i = 0; i < 9; ++i) {
          const std::uint32_t there = seen(x + i % 3 - 1, y + i / 3 - 1);
          its.push_back(there == own);
          if (there != own && (other == own || there > other)) other = there;
        }
        EXPECT_EQ(border & kLabelMask, own) << x << "," << y;
        EXPECT_EQ(border >> kLabelBits & kLabelMask, other) << x << "," << y;
        EXPECT_NEAR(shareOf(border), oracles::paintableShare(its), kShareStep);
        ofMovers += own == kMover ? 1 : 0;
        clipped += other != own ? 1 : 0;
      }
    }
    EXPECT_GT(ofMovers, 30);
    EXPECT_GT(clipped, 100);
  }
}

/// A disc moves before a wall and past a model, at all places of blocks.
TEST_F(ClipTest, BordersWhereSomethingMayBeAreThoseOfTheWholePicture) {
  for (const double quality : {1.0, 0.7}) {
    for (const bool hasObjects : {false, true}) {
      SCOPED_TRACE(testing::Message() << quality << " " << hasObjects);
      const hal::FrameSize size{static_cast<int>(quality * kSize.width),
                                static_cast<int>(quality * kSize.height)};
      const glm::ivec4 model(quality * glm::dvec4(120.0, 40.0, 150.0, 90.0));
      setIds(size, [&](int x, int y) -> std::uint32_t {
        return hasObjects && x >= model.x && y >= model.y && x < model.z && y < model.w ? 3 : 0;
      });
      marks::MotionField motion(library_, kSize);
      marks::MotionLayers layers(library_, kSize);
      StrokeBorders borders(library_);
      restart();
      std::size_t atBorders = 0;
      for (int i = 0; i < 24; ++i) {
        const marks::View disc{
            .disc = quality * glm::dvec2(30.0 + 7.0 * i, 70.0 + 3.0 * std::sin(0.7 * i)),
            .radius = i < 4 ? 0.0 : quality * 21.0};
        scene::ArFrame frame = next(marks::seen(disc, size, static_cast<unsigned>(i + 1)));
        frame.fullSize = kSize;
        motion.update(frame);
        layers.update(frame, motion);
        ASSERT_TRUE(layers.isStanding() || i == 0);
        frame.hasObjects = hasObjects;
        frame.forms = &forms_;
        if (hasObjects) frame.objectBounds = model;
        const gpu::Texture sparse(gpu::TextureFormat::kR32ui, size);
        borders.draw(frame, &layers, gpu::RenderTarget({&sparse}));
        const gpu::Texture whole(gpu::TextureFormat::kR32ui, size);
        bordersProgram()
            .texture("picture", *frame.colour)
            .texture("forms", forms_)
            .texture("depth", *frame.colour)
            .set("depthRange", glm::vec2(0.0F))
            .texture("moverShares", layers.shares())
            .texture("background", layers.background())
            .set("hasObjects", hasObjects ? 1 : 0)
            .set("objectBounds", glm::vec4(model))
            .set("size", glm::vec2(size.width, size.height))
            .set("pixelsOfFull", glm::vec2(frame.pixelsOfFull()))
            .drawFullscreen(gpu::RenderTarget({&whole}));
        const std::vector<std::uint32_t> found = support::readR32ui(sparse);
        ASSERT_EQ(found, support::readR32ui(whole)) << "frame " << i;
        atBorders += static_cast<std::size_t>(
            std::ranges::count_if(found, [](std::uint32_t each) { return each != 31U << 26U; }));
      }
      EXPECT_GT(atBorders, 2000U);
    }
  }
}

/// Strokes far from models are traced by a smaller program, and regions of the field ask for no
/// models there.
TEST_F(ClipTest, APictureIsTheSameWhereverModelsAreLookedFor) {
  constexpr glm::ivec4 kModel{24, 20, 58, 66};
  setIds(kSize, [&](int x, int y) -> std::uint32_t {
    return x >= kModel.x && y >= kModel.y && x < kModel.z && y < kModel.w ? 3 : 0;
  });
  const auto film = [&](std::optional<glm::ivec4> bounds) {
    restart();
    Painterly style(library_);
    style.setParameters(style.parameters().with("stroke_size", "2.5"));
    std::vector<std::vector<std::uint8_t>> painted;
    for (int i = 0; i < 10; ++i) {
      scene::ArFrame frame = next(1.5 * i, i == 0 ? 0.0 : 1.5);
      frame.hasObjects = true;
      frame.ids = &ids_;
      frame.forms = &forms_;
      frame.barycentrics = &zeros_;
      frame.normalFocus = &picture_;
      frame.objectBounds = bounds;
      painted.push_back(paint(style, frame));
    }
    return painted;
  };
  const auto known = film(kModel);
  const auto everywhere = film(std::nullopt);
  const auto elsewhere = film(glm::ivec4(150, 110, 170, 130));
  for (std::size_t i = 0; i < known.size(); ++i) {
    // The two programs may round differently, which changes single strokes by a level.
    EXPECT_LT(meanDifference(known[i], everywhere[i]), 0.01) << "frame " << i;
  }
  EXPECT_GT(meanDifference(known.back(), elsewhere.back()), 0.1) << "the control";
}

/// A red disc on blue.
class SpillTest : public ClipTest {
 protected:
  static double beyondDisc(double x, double y) { return std::hypot(x - 96.0, y - 72.0) - 40.0; }
  static hal::Image disc() {
    hal::Image image({.pixelFormat = hal::PixelFormat::kRgba8, .size = kSize});
    for (int y = 0; y < kSize.height; ++y) {
      for (int x = 0; x < kSize.width; ++x) {
        auto* p = image.row(0, y).data() + std::ptrdiff_t{x} * 4;
        const bool isIn = beyondDisc(x, y) < 0.0;
        p[0] = isIn ? 220 : 20;
        p[1] = 20;
        p[2] = isIn ? 20 : 220;
        p[3] = 255;
      }
    }
    return image;
  }

  int spilled(std::uint32_t object, bool isKnown, const char* bump = "once",
              const char* clip = "true", const char* modelSpace = "true") {
    restart();
    setIds(kSize, [&](int x, int y) { return beyondDisc(x, y) < 0.0 ? object : 0U; });
    Painterly style(library_);
    style.setParameters(spilling(style.parameters(),
                                 {{"bump", bump}, {"clip", clip}, {"model_space", modelSpace}}));
    std::vector<std::uint8_t> painted;
    for (int i = 0; i < 3; ++i) {
      scene::ArFrame frame = next(disc());
      frame.hasObjects = isKnown;
      frame.ids = &ids_;
      frame.forms = &forms_;
      frame.barycentrics = &zeros_;
      frame.normalFocus = &picture_;
      painted = paint(style, frame);
    }
    return spilledPixels(painted, kSize, beyondDisc);
  }
};

TEST_F(SpillTest, NoPaintRunsOverAModelsBoundary) {
  const int clipped = spilled(1, true);
  const int unclipped = spilled(1, false);
  RecordProperty("pixels", std::to_string(clipped) + " of " + std::to_string(unclipped));
  EXPECT_GT(unclipped, 100) << "strokes are to reach over where nothing is known";
  EXPECT_EQ(clipped, 0);
  EXPECT_EQ(spilled(1, true, "each"), 0);
  EXPECT_GT(spilled(1, true, "once", "false"), 100) << "clip = false lets paint run over it";
}

TEST_F(SpillTest, OutOfModelSpaceNoModelIsKnown) {
  const int unknown = spilled(1, false);
  EXPECT_GT(unknown, 100);
  EXPECT_EQ(spilled(1, true, "once", "true", "false"), unknown);
}

/// The canvas goes with the camera's image, and a model does not.
TEST_F(SpillTest, TheCanvassThreadsDoNotShowOnModels) {
  const auto paintedOn = [this](const char* canvas) {
    restart();
    setIds(kSize, [](int x, int y) { return beyondDisc(x, y) < 0.0 ? 1U : 0U; });
    Painterly style(library_);
    style.setParameters(style.parameters().with("canvas", canvas));
    scene::ArFrame frame = next(disc());
    frame.hasObjects = true;
    frame.ids = &ids_;
    frame.forms = &forms_;
    frame.barycentrics = &zeros_;
    frame.normalFocus = &picture_;
    return paint(style, frame);
  };
  const std::vector<std::uint8_t> plain = paintedOn("0");
  const std::vector<std::uint8_t> woven = paintedOn("1");
  int onModel = 0;
  int inImage = 0;
  for (std::size_t i = 0; i < plain.size(); ++i) {
    const auto pixel = static_cast<int>(i / 4);
    const bool isOnModel = beyondDisc(pixel % kSize.width, pixel / kSize.width) < 0.0;
    (isOnModel ? onModel : inImage) += plain[i] != woven[i] ? 1 : 0;
  }
  EXPECT_EQ(onModel, 0);
  EXPECT_GT(inImage, 10'000);
}

/// An occluder's outline is where its model was put, not where the picture has an edge.
TEST_F(SpillTest, OverAnOccludersOutlineThePictureGoesOn) {
  const int clipped = spilled(1, true);
  EXPECT_GT(spilled(scene::kRealObject + 1U, true), clipped);
}

}  // namespace
}  // namespace pleinair::styles
