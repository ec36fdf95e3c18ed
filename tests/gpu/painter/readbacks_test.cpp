#include "tests/gpu/painter/painter_fixture.h"
#include "tests/support/process_resources.h"

namespace pleinair {
namespace {

using hal::PixelFormat;

const PainterOptions kPlain{.pictureSize = {96, 64}, .style = "none"};

void paintFrames(Painter& painter, int first, int end) {
  const PaintParameters parameters = painter.defaultParameters();
  for (int i = first; i < end; ++i) ASSERT_TRUE(painter.paint(testFrame(i), parameters));
}

TEST_F(PainterTest, ReadsPicturesInOrder) {
  Painter painter(kPlain);
  const int readback = painter.openReadback({PixelFormat::kRgb8, {96, 64}});
  OutputFrame picture;
  EXPECT_FALSE(hal::orThrow(painter.poll(readback, picture)));
  EXPECT_FALSE(hal::orThrow(painter.wait(readback, picture)));
  paintFrames(painter, 0, 3);
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(hal::orThrow(painter.wait(readback, picture)));
    const hal::CapturedFrame frame = testFrame(i);
    EXPECT_EQ(picture.sequence, frame.sequence);
    EXPECT_EQ(picture.captureTime, frame.captureTime);
    EXPECT_EQ(bytesOf(picture.image), bytesOf(hal::Image(frame.image))) << i;
  }
  EXPECT_FALSE(hal::orThrow(painter.wait(readback, picture)));
  EXPECT_EQ(painter.skipped(readback), 0u);
}

TEST_F(PainterTest, TakesWithoutWaitingOnceTheGpuIsDone) {
  Painter painter(kPlain);
  const int readback = painter.openReadback({PixelFormat::kRgb8, {96, 64}});
  paintFrames(painter, 0, 1);
  const hal::Image snapshot = hal::orThrow(painter.snapshot());  // waits for the GPU
  OutputFrame picture;
  ASSERT_TRUE(hal::orThrow(painter.poll(readback, picture)));
  EXPECT_EQ(bytesOf(picture.image), bytesOf(snapshot));
  EXPECT_FALSE(hal::orThrow(painter.poll(readback, picture)));
}

TEST_F(PainterTest, SkipsPicturesWhileAReaderIsFull) {
  Painter painter(kPlain);
  const int slow = painter.openReadback({PixelFormat::kGrey8, {48, 32}});
  EXPECT_TRUE(painter.hasRoom(slow));
  paintFrames(painter, 0, 3);
  EXPECT_FALSE(painter.hasRoom(slow));
  const int late = painter.openReadback({PixelFormat::kGrey8, {48, 32}});
  paintFrames(painter, 3, 5);
  EXPECT_EQ(painter.skipped(slow), 2u);
  EXPECT_EQ(painter.skipped(late), 0u);
  OutputFrame picture;
  for (const std::uint64_t sequence : {0u, 1u, 2u}) {
    ASSERT_TRUE(hal::orThrow(painter.wait(slow, picture)));
    EXPECT_EQ(picture.sequence, sequence);
  }
  EXPECT_FALSE(hal::orThrow(painter.wait(slow, picture)));
  paintFrames(painter, 5, 6);
  ASSERT_TRUE(hal::orThrow(painter.wait(slow, picture)));
  EXPECT_EQ(picture.sequence, 5u);
  for (const std::uint64_t sequence : {3u, 4u, 5u}) {
    ASSERT_TRUE(hal::orThrow(painter.wait(late, picture)));
    EXPECT_EQ(picture.sequence, sequence);
  }
}

TEST_F(PainterTest, OpensAndClosesReadbacksWhilePicturesAreInFlight) {
  Painter painter(kPlain);
  const int first = painter.openReadback({PixelFormat::kRgb8, {96, 64}});
  const int second = painter.openReadback({PixelFormat::kGrey8, {48, 32}});
  paintFrames(painter, 0, 2);
  painter.closeReadback(second);  // with two pictures in flight
  const int third = painter.openReadback({PixelFormat::kRgb8, {96, 64}});
  EXPECT_NE(third, second) << "no number comes twice";
  paintFrames(painter, 2, 3);
  OutputFrame picture;
  for (const std::uint64_t sequence : {0u, 1u, 2u}) {
    ASSERT_TRUE(hal::orThrow(painter.wait(first, picture)));
    EXPECT_EQ(picture.sequence, sequence);
    EXPECT_EQ(bytesOf(picture.image),
              bytesOf(hal::Image(testFrame(static_cast<int>(sequence)).image)));
  }
  ASSERT_TRUE(hal::orThrow(painter.wait(third, picture)));
  EXPECT_EQ(picture.sequence, 2u) << "the first since it was opened";
  EXPECT_EQ(bytesOf(picture.image), bytesOf(hal::Image(testFrame(2).image)));
  painter.closeReadback(first);
  painter.closeReadback(third);
  paintFrames(painter, 3, 5);  // nothing is read
  EXPECT_FALSE(hal::orThrow(painter.waitForAny(std::chrono::seconds(1))));
}

TEST_F(PainterTest, PaintsTheSameWhateverReadbacksComeAndGo) {
  Painter plain({.pictureSize = {96, 64}});
  Painter read({.pictureSize = {96, 64}});
  for (int i = 0; i < 6; ++i) {
    const int readback = read.openReadback({PixelFormat::kI420, {64, 48}});
    EXPECT_EQ(painted(read, testFrame(i)), painted(plain, testFrame(i))) << i;
    if (i % 2 == 0) read.closeReadback(readback);
  }
}

TEST_F(PainterTest, ReadbacksThatComeAndGoLeaveNoMemoryBehind) {
  Painter painter(kPlain);
  int frames = 0;
  const auto comeAndGo = [&](int times) {
    for (int i = 0; i < times; ++i) {
      const int readback = painter.openReadback({PixelFormat::kRgba8, {640, 360}});
      paintFrames(painter, frames, frames + 2);
      frames += 2;
      OutputFrame picture;
      ASSERT_TRUE(hal::orThrow(painter.wait(readback, picture)));
      painter.closeReadback(readback);
    }
  };
  comeAndGo(5);
  const std::size_t before = support::ProcessResources::allocatedBytes();
  comeAndGo(20);
  const std::size_t half = support::ProcessResources::allocatedBytes();
  comeAndGo(20);
  const std::size_t after = support::ProcessResources::allocatedBytes();
  RecordProperty("first_half_bytes", static_cast<int>(half) - static_cast<int>(before));
  RecordProperty("second_half_bytes", static_cast<int>(after) - static_cast<int>(half));
  EXPECT_LT(after, half + 50'000) << "a picture alone has 900,000 bytes";
}

TEST_F(PainterTest, WaitsForTheOldestPictureOfAllReadbacks) {
  Painter painter(kPlain);
  const int slow = painter.openReadback({PixelFormat::kRgb8, {96, 64}});
  const int fast = painter.openReadback({PixelFormat::kGrey8, {48, 32}});
  EXPECT_FALSE(hal::orThrow(painter.waitForAny(std::chrono::minutes(1)))) << "none is in flight";
  paintFrames(painter, 0, 2);
  OutputFrame picture;
  for (const int readback : {slow, fast, slow, fast}) {
    ASSERT_TRUE(hal::orThrow(painter.waitForAny(std::chrono::minutes(1))));
    ASSERT_TRUE(hal::orThrow(painter.poll(readback, picture))) << readback;
  }
  EXPECT_FALSE(hal::orThrow(painter.waitForAny(std::chrono::minutes(1)))) << "all are taken";
}

TEST_F(PainterTest, ReadsIntoSeveralLayoutsAndSizesAtOnce) {
  const hal::ColorEncoding limited;
  struct Wanted {
    hal::FrameFormat format;
    std::vector<std::uint8_t> planes;  // of light grey, 200; packed ones: what repeats
  };
  const std::vector<Wanted> all{{{PixelFormat::kRgba8, {96, 64}, {}}, {200, 200, 200, 255}},
                                {{PixelFormat::kRgb8, {31, 17}, {}}, {200, 200, 200}},
                                {{PixelFormat::kGrey8, {7, 90}, {}}, {200}},
                                {{PixelFormat::kYuyv, {48, 32}, limited}, {188, 128}},
                                {{PixelFormat::kI420, {33, 21}, limited}, {188, 128, 128}},
                                {{PixelFormat::kNv12, {34, 20}, limited}, {188, 128}}};
  Painter painter(kPlain);
  std::vector<int> readers;
  readers.reserve(all.size());
  for (const Wanted& wanted : all) readers.push_back(painter.openReadback(wanted.format));
  hal::Image grey({.pixelFormat = PixelFormat::kRgb8, .size = {96, 64}});
  std::ranges::fill(grey.plane(0), std::uint8_t{200});
  painted(painter, frameOf(std::move(grey), 0));
  OutputFrame picture;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto& [format, planes] = all[i];
    ASSERT_TRUE(hal::orThrow(painter.wait(readers[i], picture)));
    ASSERT_EQ(picture.image.format(), format);
    const bool isPlanar =
        format.pixelFormat == PixelFormat::kI420 || format.pixelFormat == PixelFormat::kNv12;
    for (int plane = 0; plane < planeCount(format.pixelFormat); ++plane) {
      const auto bytes = picture.image.plane(plane);
      for (std::size_t at = 0; at < bytes.size(); ++at) {
        const auto expected =
            planes[isPlanar ? static_cast<std::size_t>(plane) : at % planes.size()];
        ASSERT_EQ(bytes[at], expected) << toString(format.pixelFormat) << ' ' << plane << ' ' << at;
      }
    }
  }
}

}  // namespace
}  // namespace pleinair
