#include <thread>

#include <gmock/gmock.h>

#include "tests/gpu/painter/painter_fixture.h"

namespace pleinair {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using Bytes = std::vector<std::uint8_t>;

constexpr int kFrames = 4;
const PainterOptions kWide{.pictureSize = {96, 64}};
const PainterOptions kTall{.pictureSize = {60, 80}};

PaintParameters smallCells(const Painter& painter) {
  PaintParameters parameters = painter.defaultParameters();
  parameters.style = parameters.style.with("cell_size", "6");
  return parameters;
}

std::vector<Bytes> paintedAlone(const PainterOptions& options) {
  Painter painter(options);
  const PaintParameters parameters = smallCells(painter);
  std::vector<Bytes> pictures;
  pictures.reserve(kFrames);
  for (int i = 0; i < kFrames; ++i) pictures.push_back(painted(painter, testFrame(i), parameters));
  return pictures;
}

std::string startupErrorOf(const PainterOptions& options) {
  try {
    const Painter painter(options);
  } catch (const hal::Failure& error) {
    EXPECT_EQ(error.error().kind, hal::ErrorKind::kInvalidArgument);
    return error.what();
  }
  return "(nothing thrown)";
}

TEST_F(PainterTest, PaintsTheSameFramesTheSame) {
  const auto pictures = paintedAlone(kWide);
  EXPECT_EQ(paintedAlone(kWide), pictures);
  EXPECT_NE(pictures.front(), pictures.back());
}

TEST_F(PainterTest, ItsDefaultsAreNotWhatIsInForce) {
  Painter painter(kWide);
  const PaintParameters defaults = painter.defaultParameters();
  ASSERT_TRUE(painter.paint(testFrame(0), smallCells(painter)));
  EXPECT_TRUE(painter.defaultParameters().style == defaults.style);
}

TEST_F(PainterTest, IsIndependentOfOthersInTheProcess) {
  const auto wideAlone = paintedAlone(kWide);
  const auto tallAlone = paintedAlone(kTall);
  Painter wide(kWide);
  Painter tall(kTall);
  for (std::size_t i = 0; i < kFrames; ++i) {
    const hal::CapturedFrame frame = testFrame(static_cast<int>(i));
    EXPECT_EQ(painted(wide, frame, smallCells(wide)), wideAlone[i]) << i;
    EXPECT_EQ(painted(tall, frame, smallCells(tall)), tallAlone[i]) << i;
  }
}

TEST_F(PainterTest, PaintsBesideOthersOnOtherThreads) {
  const auto alone = paintedAlone(kTall);
  std::vector<Bytes> first;
  std::vector<Bytes> second;
  std::thread one([&first] { first = paintedAlone(kTall); });
  std::thread two([&second] { second = paintedAlone(kTall); });
  one.join();
  two.join();
  EXPECT_EQ(first, alone);
  EXPECT_EQ(second, alone);
}

TEST_F(PainterTest, StartsAnewAfterReset) {
  const auto fromTheStart = paintedAlone(kWide);
  Painter painter(kWide);
  const Bytes second = painted(painter, testFrame(1), smallCells(painter));
  EXPECT_NE(painted(painter, testFrame(0), smallCells(painter)), fromTheStart[0]);
  painter.reset();
  EXPECT_EQ(painted(painter, testFrame(0), smallCells(painter)), fromTheStart[0]);
  EXPECT_EQ(painted(painter, testFrame(1), smallCells(painter)), fromTheStart[1]);
  EXPECT_NE(second, fromTheStart[1]);  // it was a first frame then
}

TEST_F(PainterTest, TellsWhatItPainted) {
  Painter painter(kWide);
  EXPECT_FALSE(painter.contextInfo().renderer.empty());
  const auto picture = painter.paint(testFrame(5), painter.defaultParameters());
  ASSERT_TRUE(picture);
  EXPECT_EQ(picture->sequence, 5u);
  EXPECT_EQ(picture->captureTime, testFrame(5).captureTime);
  EXPECT_EQ(picture->size, kWide.pictureSize);
  EXPECT_NE(picture->texture, 0u);
  EXPECT_TRUE(picture->tracking.tags.empty());
}

TEST_F(PainterTest, ReadsStillsOfThePaintingAndOfTheCamera) {
  Painter painter(kWide);
  const hal::CapturedFrame frame = testFrame(0);
  ASSERT_TRUE(painter.paint(frame, painter.defaultParameters()));
  const hal::Image camera = hal::orThrow(painter.cameraSnapshot());
  EXPECT_EQ(camera.format().pixelFormat, hal::PixelFormat::kRgb8);
  EXPECT_EQ(bytesOf(camera), bytesOf(hal::Image(frame.image)));
  EXPECT_EQ(hal::orThrow(painter.snapshot()).format(), camera.format());
  EXPECT_NE(bytesOf(hal::orThrow(painter.snapshot())), bytesOf(camera));
}

TEST_F(PainterTest, ShowsEveryViewAndGoesOnTheSame) {
  const auto pictures = paintedAlone(kWide);
  Painter plain(kWide);
  for (const DebugView& view : plain.views()) {
    Painter painter(kWide);
    PaintParameters parameters = smallCells(painter);
    painted(painter, testFrame(0), parameters);
    parameters.view = view.name;
    EXPECT_NE(painted(painter, testFrame(1), parameters), pictures[1]) << view.name;
    EXPECT_FALSE(view.help.empty()) << view.name;
    EXPECT_EQ(painted(painter, testFrame(2), smallCells(painter)), pictures[2]) << view.name;
  }
}

TEST_F(PainterTest, TakesFramesThatChangeInMidStream) {
  const std::vector<hal::CapturedFrame> frames{testFrame(0, {96, 64}, hal::PixelFormat::kI420),
                                               testFrame(1, {96, 64}),
                                               testFrame(2, {48, 80}),
                                               testFrame(3, {33, 17}, hal::PixelFormat::kNv12),
                                               testFrame(4, {33, 17}, hal::PixelFormat::kGrey8),
                                               testFrame(5, {96, 64}, hal::PixelFormat::kYuyv)};
  const PainterOptions options{.pictureSize = {96, 64}, .style = "none"};
  Painter painter(options);
  for (const hal::CapturedFrame& frame : frames) {
    Painter fresh(options);
    EXPECT_EQ(painted(painter, frame), painted(fresh, frame)) << frame.sequence;
  }
  Painter watercolor(kWide);
  for (const hal::CapturedFrame& frame : frames) {
    const auto picture = watercolor.paint(frame, watercolor.defaultParameters());
    ASSERT_TRUE(picture) << frame.sequence;
    EXPECT_EQ(picture->size, kWide.pictureSize) << frame.sequence;
  }
}

TEST_F(PainterTest, PaintsASinglePixel) {
  for (const std::string style : {"none", "watercolor"}) {
    for (const hal::FrameSize frame : {hal::FrameSize{1, 1}, hal::FrameSize{40, 30}}) {
      for (const hal::FrameSize picture : {hal::FrameSize{1, 1}, hal::FrameSize{40, 30}}) {
        Painter painter({.pictureSize = picture, .style = style});
        painted(painter, testFrame(0, frame));
        painted(painter, testFrame(1, frame));
        EXPECT_EQ(hal::orThrow(painter.snapshot()).size(), picture) << style;
      }
    }
  }
}

TEST_F(PainterTest, NamesTheViewsWhereOneIsUnknownAndGoesOn) {
  const auto pictures = paintedAlone(kWide);
  Painter painter(kWide);
  EXPECT_EQ(painted(painter, testFrame(0), smallCells(painter)), pictures[0]);
  PaintParameters parameters = smallCells(painter);
  parameters.view = "cels";
  const auto refused = painter.paint(testFrame(1), parameters);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, hal::ErrorKind::kInvalidArgument);
  EXPECT_THAT(refused.error().message(),
              AllOf(HasSubstr("\"cels\""), HasSubstr("camera, ar, depth, objects"),
                    HasSubstr("seeds, cells")));
  EXPECT_EQ(painted(painter, testFrame(1), smallCells(painter)), pictures[1]);
}

TEST_F(PainterTest, NamesBothSizesWhereTheCalibrationIsForAnother) {
  PainterOptions options = kWide;
  options.scene.camera = scene::assumedCamera({96, 64});
  Painter painter(options);
  const PaintParameters parameters = painter.defaultParameters();
  const auto early = painter.paint(testFrame(0, {48, 32}), parameters);
  ASSERT_FALSE(early);
  EXPECT_EQ(early.error().kind, hal::ErrorKind::kInvalidInput);
  EXPECT_THAT(early.error().message(), AllOf(HasSubstr("96x64"), HasSubstr("48x32")));
  EXPECT_TRUE(painter.paint(testFrame(1, {96, 64}), parameters));
  EXPECT_FALSE(painter.paint(testFrame(2, {64, 96}), parameters));
  EXPECT_TRUE(painter.paint(testFrame(3, {96, 64}), parameters));
}

TEST_F(PainterTest, PaintsTheSameWhateverFormatItExpected) {
  const hal::CapturedFrame frame = testFrame(0, {64, 48}, hal::PixelFormat::kI420);
  Painter unaware(kWide);
  const auto expected = painted(unaware, frame);
  for (const hal::PixelFormat format : {hal::PixelFormat::kI420, hal::PixelFormat::kBayerRggb8}) {
    PainterOptions options = kWide;
    options.expectedFormat = hal::FrameFormat{.pixelFormat = format, .size = {64, 48}};
    options.passTiming = gpu::PassTiming::kFences;
    Painter aware(options);
    EXPECT_TRUE(aware.passTimes().empty()) << "timed the warm-up";
    EXPECT_EQ(painted(aware, frame), expected);
    EXPECT_EQ(aware.passTimes().front().pass, "camera picture");
    EXPECT_EQ(aware.passTimes().front().count, 1);
  }
}

TEST_F(PainterTest, RefusesFramesAndReadersBeyondTheGpusLimitAndGoesOn) {
  Painter painter({.pictureSize = {96, 64}, .style = "none"});
  const int side = painter.contextInfo().maxSidePixels;
  const std::vector<std::uint8_t> bytes(static_cast<std::size_t>(side) + 1);
  hal::ImageView picture{.format = {.pixelFormat = hal::PixelFormat::kGrey8, .size = {side + 1, 1}},
                         .planes = {}};
  picture.planes[0] = {.bytes = bytes, .strideBytes = bytes.size()};
  const hal::CapturedFrame wide{.image = picture};
  const auto refused = painter.paint(wide, painter.defaultParameters());
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, hal::ErrorKind::kUnsupported);
  EXPECT_THAT(refused.error().message(), HasSubstr(std::to_string(side) + " px"));
  try {
    painter.openReadback({hal::PixelFormat::kGrey8, {4, side + 1}});
    ADD_FAILURE() << "opened";
  } catch (const hal::Failure& error) {
    EXPECT_EQ(error.error().kind, hal::ErrorKind::kUnsupported);
    EXPECT_THAT(error.what(), HasSubstr(std::to_string(side) + " px"));
  }
  EXPECT_TRUE(painter.paint(testFrame(1), painter.defaultParameters()));
}

TEST_F(PainterTest, RefusesWhatItCannotPaintAtTheStart) {
  EXPECT_THAT(startupErrorOf({.pictureSize = {96, 64}, .style = "watercolour"}),
              AllOf(HasSubstr("\"watercolour\""), HasSubstr("none"), HasSubstr("watercolor")));
  EXPECT_THAT(startupErrorOf({.pictureSize = {0, 64}}), HasSubstr("0x64"));
  EXPECT_THAT(startupErrorOf({.pictureSize = {9000, 2}}), HasSubstr("8192"));
  PainterOptions options = kWide;
  options.scene.tagFamily = "tag99h99";
  EXPECT_THAT(startupErrorOf(options), AllOf(HasSubstr("tag99h99"), HasSubstr("tag36h11")));
}

TEST_F(PainterTest, CanBeCancelledWhileItIsMade) {
  for (const int programs : {0, 3, 30}) {
    int asked = 0;
    const auto isCancelled = [&] { return ++asked > programs; };
    try {
      Painter painter({.pictureSize = {96, 64}, .qualityLevels = true, .isCancelled = isCancelled});
      ADD_FAILURE() << "was made";
    } catch (const hal::Failure& failure) {
      EXPECT_EQ(failure.error().kind, hal::ErrorKind::kCancelled);
    }
    EXPECT_EQ(asked, programs + 1) << "went on after it was cancelled";
  }
  int asked = 0;
  Painter painter({.pictureSize = {96, 64}, .isCancelled = [&] { return ++asked < 0; }});
  EXPECT_GT(asked, 30);
  const int whileMade = asked;
  ASSERT_TRUE(painter.paint(testFrame(0), painter.defaultParameters()));
  EXPECT_EQ(asked, whileMade) << "what is made later cannot be cancelled";
}

}  // namespace
}  // namespace pleinair
