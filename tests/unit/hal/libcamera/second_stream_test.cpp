// The second, small image that some cameras make of each frame, for trackers.
#include <chrono>
#include <optional>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/cameras/libcamera/frame_layout.h"
#include "tests/unit/hal/libcamera/fake_sensor_test.h"

namespace pleinair::hal::libcamera {
namespace {

using testing::HasSubstr;

constexpr std::uint32_t kNv12Code = 0x3231564E;
constexpr std::uint32_t kR8Code = 0x20203852;

class SecondStreamTest : public FakeSensorTest {
 protected:
  static StreamRequest wanting(int sidePx) {
    return {.size = FrameSize{128, 96}, .lumaSidePx = sidePx};
  }
  /// Starts with a second image wished for, and gives why there is none.
  std::string note(const StreamRequest& request = wanting(32)) {
    const Result<StreamFormat> format = start(request);
    if (!format) return format.error().message();
    if (format->luma) return "has one";
    const CapturedFrame taken = frame();
    EXPECT_FALSE(taken.luma);
    EXPECT_EQ(taken.image.format.size, format->frame.size);
    return format->lumaNote;
  }
};

TEST_F(SecondStreamTest, ShowsTheSameFrameSmall) {
  sensor.luma = kNv12Code;
  sensor.rowPadding = 12;
  const Result<StreamFormat> format = start(wanting(32));
  ASSERT_TRUE(format) << format.error().message();
  ASSERT_TRUE(format->luma);
  EXPECT_EQ(*format->luma,
            (FrameFormat{.pixelFormat = PixelFormat::kGrey8, .size = FrameSize{32, 24}}));
  EXPECT_EQ(format->frame.size, (FrameSize{128, 96}));
  for (unsigned number = 0; number < 3; ++number) {
    const CapturedFrame taken = frame();
    ASSERT_TRUE(taken.luma);
    EXPECT_EQ(taken.luma->format, *format->luma);
    const FrameMapping mapped = taken.luma->map();
    ASSERT_TRUE(mapped.view().isComplete());
    // Of the same number as the frame, row 1 beginning behind the padding of row 0.
    EXPECT_EQ(mapped.view().row(0, 0)[0], 128 + number);
    EXPECT_EQ(mapped.view().row(0, 1)[0], 128 + 44 + number);
    EXPECT_EQ(taken.image.map().view().row(0, 0)[0], number);
  }
}

TEST_F(SecondStreamTest, IsCopiedWithTheFrame) {
  sensor.luma = kR8Code;
  options.buffers = 4;
  ASSERT_TRUE(start(wanting(32)));
  std::vector<CapturedFrame> held;
  for (int i = 0; i < 8; ++i) held.push_back(frame());
  // The first two are lent, the others copied; all keep their own pixels.
  for (unsigned number = 0; number < 8; ++number) {
    ASSERT_TRUE(held[number].luma);
    EXPECT_EQ(held[number].luma->map().view().row(0, 0)[0], 128 + number) << number;
    EXPECT_EQ(held[number].image.map().view().row(0, 0)[0], number) << number;
  }
  camera_->stop();
  EXPECT_EQ(held[0].luma->map().view().row(0, 0)[0], 128);
}

TEST_F(SecondStreamTest, IsThereBesideConvertedFrames) {
  sensor.formats = {{.fourcc = 0x34325258, .sizes = {{128, 96}}}};  // XRGB8888
  sensor.luma = kNv12Code;
  ASSERT_TRUE(start(wanting(64)));
  const CapturedFrame taken = frame();
  ASSERT_TRUE(taken.luma);
  EXPECT_EQ(taken.luma->format.size, (FrameSize{64, 48}));
  EXPECT_EQ(taken.luma->map().view().row(0, 0)[0], 128);
}

TEST_F(SecondStreamTest, IsNotAskedForUnlessWanted) {
  sensor.luma = kNv12Code;
  const Result<StreamFormat> format = start({.size = FrameSize{128, 96}});
  ASSERT_TRUE(format);
  EXPECT_FALSE(format->luma);
  EXPECT_TRUE(format->lumaNote.empty());
  EXPECT_FALSE(frame().luma);
  options.makesLuma = false;
  ASSERT_TRUE(start(wanting(32)));
  EXPECT_FALSE(library_.told.wish.luma);
  EXPECT_FALSE(frame().luma);
}

TEST_F(SecondStreamTest, SaysWhyThereIsNone) {
  EXPECT_THAT(note(), HasSubstr("one image"));
  sensor.luma = kNv12Code;
  EXPECT_THAT(note(wanting(128)), HasSubstr("no larger"));
  sensor.lumaSize = FrameSize{32, 30};
  EXPECT_THAT(note(), HasSubstr("another part of the view"));
  sensor.lumaSize = FrameSize{128, 96};
  EXPECT_THAT(note(), HasSubstr("another part of the view"));
  sensor.lumaSize.reset();
  sensor.luma = 0x56595559;  // YUYV
  EXPECT_THAT(note(), HasSubstr("no plane of luma: YUYV"));
  sensor.luma = kNv12Code;
  sensor.changesBesideLuma = true;
  EXPECT_THAT(note(), HasSubstr("would be others"));
  EXPECT_FALSE(library_.told.wish.luma) << "it was configured again without";
}

TEST_F(SecondStreamTest, OfWhichSomeIsMissingMakesTheFrameIncomplete) {
  sensor.luma = kNv12Code;
  sensor.frames[1] = {.missingLumaBytes = 1};
  ASSERT_TRUE(start(wanting(32)));
  EXPECT_EQ(frame().health, FrameHealth::kValid);
  EXPECT_EQ(frame().health, FrameHealth::kIncomplete);
  EXPECT_EQ(frame().health, FrameHealth::kValid);
}

TEST(LumaSize, HasTheFramesShape) {
  EXPECT_EQ(lumaSizeFor({1280, 720}, 640), (FrameSize{640, 360}));
  EXPECT_EQ(lumaSizeFor({1640, 1232}, 640), (FrameSize{640, 480}));
  EXPECT_EQ(lumaSizeFor({720, 1280}, 640), (FrameSize{360, 640}));
  EXPECT_EQ(lumaSizeFor({640, 480}, 640), std::nullopt);
  for (int width = 641; width < 4000; width += 13) {
    for (int height = 200; height < 3000; height += 17) {
      const auto size = lumaSizeFor({width, height}, 640);
      ASSERT_TRUE(size);
      EXPECT_TRUE(isReduced(*size, {width, height})) << width << "x" << height;
    }
  }
  EXPECT_FALSE(isReduced({640, 480}, {1280, 720})) << "a view that is cut at its sides";
  EXPECT_FALSE(isReduced({0, 0}, {1280, 720}));
}

}  // namespace
}  // namespace pleinair::hal::libcamera
