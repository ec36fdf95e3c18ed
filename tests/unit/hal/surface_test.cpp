#include "hal/surface.h"

#include <array>
#include <chrono>
#include <memory>
#include <vector>

#include <gtest/gtest.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include "hal/clock.h"
#include "tests/support/fake_display_output.h"

namespace pleinair::hal {
namespace {

using namespace std::chrono_literals;

class NoUnmapper final : public SurfaceUnmapper {
 public:
  void unmap(SurfaceId) override { ++calls; }
  int calls = 0;
};

class CopyToSurface : public testing::Test {
 protected:
  static constexpr FrameSize kSize{2, 2};
  static constexpr std::size_t kStride = 12;

  CopyToSurface() : picture_({.pixelFormat = PixelFormat::kRgba8, .size = kSize}) {
    std::uint8_t value = 1;
    for (std::uint8_t& byte : picture_.plane(0)) byte = value++;
  }
  Surface surfaceOf(std::uint32_t fourcc) const {
    Surface surface{.format = picture_.format(), .fourcc = fourcc};
    surface.planes[0].strideBytes = kStride;
    return surface;
  }
  Result<void> copyTo(const Surface& surface) {
    const SurfaceMapping mapping(unmapper_, surface.id, {std::span(memory_)});
    return copyToSurface(picture_.view(), surface, mapping);
  }

  Image picture_;
  NoUnmapper unmapper_;
  std::array<std::uint8_t, kStride + 8> memory_{};
};

TEST_F(CopyToSurface, PutsChannelsIntoTheOrderOfTheFourcc) {
  ASSERT_TRUE(copyTo(surfaceOf(kXrgb8888)));
  EXPECT_EQ(memory_, (std::array<std::uint8_t, 20>{3,  2,  1, 4,  7,  6,  5,  8, 0, 0, 0, 0,  //
                                                   11, 10, 9, 12, 15, 14, 13, 16}));
  ASSERT_TRUE(copyTo(surfaceOf(kAbgr8888)));
  EXPECT_EQ(memory_, (std::array<std::uint8_t, 20>{1, 2,  3,  4,  5,  6,  7,  8, 0, 0, 0, 0,  //
                                                   9, 10, 11, 12, 13, 14, 15, 16}));
  EXPECT_EQ(unmapper_.calls, 2);
}

TEST_F(CopyToSurface, RefusesWhatItCannotCopy) {
  Surface surface = surfaceOf(drmFourcc('N', 'V', '1', '2'));
  EXPECT_EQ(copyTo(surface).error().kind, ErrorKind::kUnsupported);
  surface = surfaceOf(kXrgb8888);
  surface.modifier = 1;
  EXPECT_EQ(copyTo(surface).error().kind, ErrorKind::kUnsupported);
  surface = surfaceOf(kXrgb8888);
  surface.format.size.width = 3;
  EXPECT_EQ(copyTo(surface).error().kind, ErrorKind::kInvalidArgument);
  surface = surfaceOf(kXrgb8888);
  surface.planes[0].strideBytes = kStride + 1;
  EXPECT_EQ(copyTo(surface).error().kind, ErrorKind::kInvalidArgument);
}

TEST(Fence, OwnsItsDescriptor) {
  const int file = ::eventfd(0, EFD_CLOEXEC);
  {
    Fence fence(file);
    Fence moved(std::move(fence));
    Fence other;
    other = std::move(moved);
    EXPECT_EQ(other.syncFile(), file);
  }
  EXPECT_NE(::close(file), 0) << "it is closed already";
}

TEST(FakeDisplay, ShowsASurfaceOnceItsFenceHasSignalled) {
  support::FakeDisplay display{.period = 20ms, .phase = TimePoint(0ms)};
  SteppedClock clock(TimePoint(1000ms));
  support::FakeDisplayOutput output(display, clock);
  ASSERT_TRUE(output.start({.size = {4, 4}}));
  const int signal = ::eventfd(0, EFD_CLOEXEC);
  const Surface surface = **output.acquire();
  ASSERT_TRUE(output.submit(surface, Fence(::dup(signal)), TimePoint(1020ms)));
  std::vector<PresentationEvent> events;
  clock.advance(50ms);
  ASSERT_TRUE(output.takeEvents(events));
  EXPECT_TRUE(events.empty());
  const std::uint64_t one = 1;
  ASSERT_EQ(::write(signal, &one, sizeof(one)), static_cast<ssize_t>(sizeof(one)));
  clock.advance(20ms);
  ASSERT_TRUE(output.takeEvents(events));
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].time, TimePoint(1060ms));
  EXPECT_EQ(events[0].sequence, 53u);
  ::close(signal);
}

}  // namespace
}  // namespace pleinair::hal
