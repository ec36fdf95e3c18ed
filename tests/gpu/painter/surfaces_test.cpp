// Pictures that the Painter draws straight into an output's surfaces. The tests' textures stand for
// imported ones; the import itself is tried in the guest (tests/system, display_direct).
#include <algorithm>
#include <map>
#include <optional>

#include "hal/surface_pattern.h"
#include "pipeline/gpu/gl.h"
#include "tests/gpu/painter/painter_fixture.h"

namespace pleinair {
namespace {

using hal::FrameSize;
using hal::PixelFormat;
using hal::SurfaceId;

constexpr FrameSize kPicture{96, 64};
constexpr FrameSize kWholeBuffer{120, 110};

/// Textures in the Painter's context, by the surfaces that they stand for.
class DrawnSurfaces {
 public:
  PainterOptions options() {
    PainterOptions options{.pictureSize = kPicture, .style = "none"};
    options.testHook.importSurface = [this](const hal::GpuSurface& surface) -> unsigned {
      if (isRefused) return 0;
      GLuint name = 0;
      glGenTextures(1, &name);
      glBindTexture(GL_TEXTURE_2D, name);
      glTexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA8, surface.bufferSize.width,
                     surface.bufferSize.height);
      glBindTexture(GL_TEXTURE_2D, 0);
      names_[surface.surface.id] = name;
      return name;
    };
    return options;
  }
  static std::vector<hal::GpuSurface> make(FrameSize picture, std::size_t count = 3) {
    std::vector<hal::GpuSurface> surfaces;
    for (std::size_t i = 0; i < count; ++i) {
      hal::GpuSurface surface{.bufferSize = kWholeBuffer, .x = 7, .y = 11};
      surface.surface.id = SurfaceId{static_cast<std::uint32_t>(20 + i)};
      surface.surface.format = {.pixelFormat = PixelFormat::kRgba8, .size = picture};
      surfaces.push_back(surface);
    }
    return surfaces;
  }
  /// What lies in one's memory.
  hal::Image read(SurfaceId id) const {
    hal::Image image({.pixelFormat = PixelFormat::kRgba8, .size = kWholeBuffer});
    GLuint framebuffer = 0;
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, names_.at(id), 0);
    glReadPixels(0, 0, kWholeBuffer.width, kWholeBuffer.height, GL_RGBA, GL_UNSIGNED_BYTE,
                 image.plane(0).data());
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glDeleteFramebuffers(1, &framebuffer);
    return image;
  }

  bool isRefused = false;

 private:
  std::map<SurfaceId, GLuint> names_;
};

hal::FrameSize turnedPicture(int quarterTurns) {
  return quarterTurns % 2 == 0 ? kPicture : FrameSize{kPicture.height, kPicture.width};
}

TEST_F(PainterTest, DrawsThePatternIntoEachSurface) {
  DrawnSurfaces surfaces;
  Painter painter(surfaces.options());
  const int readback = painter.openReadback({PixelFormat::kRgba8, kPicture});
  EXPECT_FALSE(painter.importSupport().modifiers.empty());
  ASSERT_TRUE(painter.importSurfaces(readback, DrawnSurfaces::make(kPicture)));
  for (const std::uint32_t id : {20U, 21U, 22U}) {
    const auto same = hal::checkSurfacePattern(surfaces.read(SurfaceId{id}).view(), SurfaceId{id});
    EXPECT_TRUE(same.has_value()) << same.error().message();
  }
  EXPECT_FALSE(hal::checkSurfacePattern(surfaces.read(SurfaceId{20}).view(), SurfaceId{21}));
}

TEST_F(PainterTest, DrawsIntoASurfaceWhatItReadsToTheBitAndBlackAroundIt) {
  for (int turns = 0; turns < 4; ++turns) {
    DrawnSurfaces surfaces;
    Painter painter(surfaces.options());
    const FrameSize size = turnedPicture(turns);
    const int read = painter.openReadback({PixelFormat::kRgba8, size}, turns);
    const int drawn = painter.openReadback({PixelFormat::kRgba8, size}, turns);
    ASSERT_TRUE(painter.importSurfaces(drawn, DrawnSurfaces::make(size)));
    painter.drawNextInto(drawn, {.loan = 4, .id = SurfaceId{21}});
    ASSERT_TRUE(painter.paint(testFrame(3), painter.defaultParameters()));
    OutputFrame memory;
    OutputFrame surface;
    ASSERT_TRUE(hal::orThrow(painter.wait(read, memory)));
    ASSERT_TRUE(hal::orThrow(painter.wait(drawn, surface)));
    EXPECT_EQ(memory.surface, std::nullopt);
    ASSERT_EQ(surface.surface, (hal::LentSurface{.loan = 4, .id = SurfaceId{21}}));
    EXPECT_EQ(surface.sequence, 3u);
    hal::Image seen = surfaces.read(SurfaceId{21});
    for (int y = 0; y < kWholeBuffer.height; ++y) {
      for (int x = 0; x < kWholeBuffer.width; ++x) {
        const auto pixel = seen.row(0, y).subspan(static_cast<std::size_t>(x) * 4, 3);
        const bool isInside = x >= 7 && x < 7 + size.width && y >= 11 && y < 11 + size.height;
        std::vector<std::uint8_t> wanted{0, 0, 0};
        if (isInside) {
          const auto at =
              memory.image.row(0, y - 11).subspan(static_cast<std::size_t>(x - 7) * 4, 3);
          wanted.assign(at.begin(), at.end());
        }
        ASSERT_TRUE(std::ranges::equal(pixel, wanted)) << turns << ": " << x << ", " << y;
      }
    }
  }
}

TEST_F(PainterTest, GivesPicturesInOrderWhereverTheyAre) {
  DrawnSurfaces surfaces;
  Painter painter(surfaces.options());
  const int readback = painter.openReadback({PixelFormat::kRgba8, kPicture});
  ASSERT_TRUE(painter.importSurfaces(readback, DrawnSurfaces::make(kPicture)));
  const PaintParameters parameters = painter.defaultParameters();
  ASSERT_TRUE(painter.paint(testFrame(0), parameters));
  painter.drawNextInto(readback, {.loan = 1, .id = SurfaceId{20}});
  ASSERT_TRUE(painter.paint(testFrame(1), parameters));
  ASSERT_TRUE(painter.paint(testFrame(2), parameters));
  OutputFrame frame;
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(hal::orThrow(painter.waitForAny(std::chrono::seconds(2))));
    ASSERT_TRUE(hal::orThrow(painter.poll(readback, frame)));
    EXPECT_EQ(frame.sequence, static_cast<std::uint64_t>(i));
    EXPECT_EQ(frame.surface.has_value(), i == 1);
  }
  EXPECT_FALSE(hal::orThrow(painter.poll(readback, frame)));
}

TEST_F(PainterTest, GoesOnWhereAnImportIsRefused) {
  DrawnSurfaces surfaces;
  surfaces.isRefused = true;
  Painter painter(surfaces.options());
  const int readback = painter.openReadback({PixelFormat::kRgba8, kPicture});
  const auto imported = painter.importSurfaces(readback, DrawnSurfaces::make(kPicture));
  ASSERT_FALSE(imported.has_value());
  EXPECT_EQ(imported.error().kind, hal::ErrorKind::kUnsupported);
  ASSERT_TRUE(painter.paint(testFrame(0), painter.defaultParameters()));
  OutputFrame frame;
  ASSERT_TRUE(hal::orThrow(painter.wait(readback, frame)));
  EXPECT_EQ(frame.surface, std::nullopt);
}

TEST_F(PainterTest, ForgetsASurfaceWhosePictureWasNotPainted) {
  DrawnSurfaces surfaces;
  Painter painter(surfaces.options());
  const int readback = painter.openReadback({PixelFormat::kRgba8, kPicture});
  ASSERT_TRUE(painter.importSurfaces(readback, DrawnSurfaces::make(kPicture)));
  painter.drawNextInto(readback, {.loan = 1, .id = SurfaceId{20}});
  PaintParameters wrong = painter.defaultParameters();
  wrong.view = "no such view";
  ASSERT_FALSE(painter.paint(testFrame(0), wrong));
  ASSERT_TRUE(painter.paint(testFrame(1), painter.defaultParameters()));
  OutputFrame frame;
  ASSERT_TRUE(hal::orThrow(painter.wait(readback, frame)));
  EXPECT_EQ(frame.surface, std::nullopt);
}

TEST_F(PainterTest, AGpuThatIsLostWhileItDrawsIntoASurfaceIsTold) {
  DrawnSurfaces surfaces;
  PainterOptions options = surfaces.options();
  bool isLost = false;
  options.testHook.waitForFence = [&](std::uint64_t) -> unsigned {
    return isLost ? GL_WAIT_FAILED : GL_ALREADY_SIGNALED;
  };
  Painter painter(options);
  const int readback = painter.openReadback({PixelFormat::kRgba8, kPicture});
  ASSERT_TRUE(painter.importSurfaces(readback, DrawnSurfaces::make(kPicture)));
  painter.drawNextInto(readback, {.loan = 1, .id = SurfaceId{20}});
  ASSERT_TRUE(painter.paint(testFrame(0), painter.defaultParameters()));
  isLost = true;
  OutputFrame frame;
  const hal::Answer polled = painter.poll(readback, frame);
  ASSERT_TRUE(polled.hasError());
  EXPECT_EQ(polled.error().kind, hal::ErrorKind::kDeviceLost);
  EXPECT_FALSE(painter.importSurfaces(readback, DrawnSurfaces::make(kPicture)).has_value());
}

}  // namespace
}  // namespace pleinair
