// The surfaces of a display that a GPU draws into.
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <vector>

#include <drm_fourcc.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "hal/outputs/display/gbm_buffers.h"
#include "tests/support/drawn_surface.h"
#include "tests/unit/hal/outputs/display/display_test.h"

namespace pleinair::hal {
namespace {

using support::FakeCardSpec;
using support::FakeMode;
using support::kPainted;

constexpr std::uint64_t kTiled = I915_FORMAT_MOD_X_TILED;
constexpr std::uint64_t kOther = I915_FORMAT_MOD_Y_TILED;
const std::vector<std::uint64_t> kDrawn{kOther, kTiled, kLinearModifier};
const std::vector<std::uint64_t> kLinear{kLinearModifier};
constexpr std::size_t kCount = 4;

FakeCardSpec gpuCard() {
  return {.gpuModifiers = {kTiled, kLinearModifier}, .planeModifiers = {kTiled, kLinearModifier}};
}

void draw(const GpuSurface& surface, std::uint32_t pixel) {
  support::drawInto(surface, [&](int, int) { return pixel; });
}

class GpuSurfaces : public support::DisplayTest {
 protected:
  void lend(std::span<const std::uint64_t> modifiers = kDrawn, std::size_t count = kCount) {
    auto lent = output_->lendToGpu(modifiers, count);
    ASSERT_TRUE(lent.has_value()) << lent.error().message();
    surfaces_ = *std::move(lent);
  }
  const GpuSurface& of(SurfaceId id) const {
    return *std::ranges::find(surfaces_, id,
                              [](const GpuSurface& each) { return each.surface.id; });
  }
  /// Draws into a free one and has it shown.
  bool showDrawn(std::uint32_t pixel = kPainted, Fence fence = {}) {
    const auto id = output_->acquireForGpu();
    if (!id || !*id) return false;
    draw(of(**id), pixel);
    const TimePoint due = clock_.now() + period_;
    const auto submitted = output_->submit(of(**id).surface, std::move(fence), due);
    EXPECT_TRUE(submitted.has_value());
    return submitted.has_value() && runTo(due + 2 * period_).has_value();
  }

  std::vector<GpuSurface> surfaces_;
};

TEST_F(GpuSurfaces, AreInALayoutThatBothThePlaneAndTheGpuTake) {
  plug(gpuCard());
  ASSERT_TRUE(start());
  lend();
  EXPECT_EQ(cards_.gpuModifiersAsked, (std::vector{kTiled, kLinearModifier}));
  ASSERT_EQ(surfaces_.size(), kCount);
  for (const GpuSurface& each : surfaces_) {
    EXPECT_EQ(each.surface.modifier, kTiled);
    EXPECT_EQ(each.bufferSize, kSize);
    EXPECT_GE(each.surface.planes[0].dmaBuf, 0);
  }
  EXPECT_GT(cards_.tests, 1) << "the card was asked whether it flips to one";
}

TEST_F(GpuSurfaces, LieInRowsWhereThePlaneNamesNoLayouts) {
  FakeCardSpec spec = gpuCard();
  spec.planeModifiers.clear();
  plug(spec);
  ASSERT_TRUE(start());
  lend();
  EXPECT_EQ(surfaces_.front().surface.modifier, kLinearModifier);
}

TEST_F(GpuSurfaces, AreShownAmongOthers) {
  plug(gpuCard());
  ASSERT_TRUE(start());
  lend();
  ASSERT_TRUE(showDrawn(1));
  ASSERT_TRUE(showAndWait(2));
  ASSERT_TRUE(showDrawn(3));
  ASSERT_EQ(cards_.shown.size(), 3u);
  EXPECT_EQ(cards_.shown[0].firstPixel, 1u);
  EXPECT_EQ(cards_.shown[1].firstPixel, 2u);
  EXPECT_EQ(cards_.shown[2].firstPixel, 3u);
  for (const PresentationEvent& each : events_) {
    EXPECT_EQ(each.result, PresentationEvent::Result::kShown);
  }
}

TEST_F(GpuSurfaces, AreLentUntilAllAreInUseAndThenAgain) {
  plug(gpuCard());
  ASSERT_TRUE(start());
  lend();
  std::vector<SurfaceId> lent;
  while (const auto id = *output_->acquireForGpu()) lent.push_back(*id);
  EXPECT_EQ(lent.size(), kCount);
  output_->release(of(lent[2]).surface);
  EXPECT_EQ(*output_->acquireForGpu(), lent[2]);
}

TEST_F(GpuSurfaces, LieWhereThePictureDoes) {
  FakeCardSpec spec = gpuCard();
  spec.connectors.front().modes = {{.size = {100, 48}}};
  plug(spec);
  ASSERT_TRUE(start());
  lend();
  EXPECT_EQ(surfaces_.front().bufferSize, (FrameSize{100, 48}));
  EXPECT_EQ(surfaces_.front().surface.format.size, kSize);
  EXPECT_EQ(surfaces_.front().x, 18);
  EXPECT_EQ(surfaces_.front().y, 0);
}

TEST_F(GpuSurfaces, CanBeLookedAt) {
  FakeCardSpec spec = gpuCard();
  spec.connectors.front().modes = {{.size = {100, 48}}};
  plug(spec);
  ASSERT_TRUE(start());
  lend();
  const SurfaceId id = **output_->acquireForGpu();
  draw(of(id), 0x00102030);
  const auto all = output_->copyOfGpuSurface(id, true);
  ASSERT_TRUE(all.has_value());
  EXPECT_EQ(all->size(), (FrameSize{100, 48}));
  auto picture = output_->copyOfGpuSurface(id, false);
  ASSERT_TRUE(picture.has_value());
  EXPECT_EQ(picture->size(), kSize);
  EXPECT_EQ(picture->row(0, 5)[0], 0x10);
  EXPECT_EQ(picture->row(0, 5)[1], 0x20);
  EXPECT_EQ(picture->row(0, 5)[2], 0x30);
  EXPECT_EQ(picture->row(0, 5)[3], 0xFF);
}

TEST_F(GpuSurfaces, AreRefusedByNameWhereTheyCannotBe) {
  struct Case {
    const char* what;
    FakeCardSpec spec;
    std::span<const std::uint64_t> modifiers = kDrawn;
    ErrorKind kind = ErrorKind::kUnsupported;
  };
  FakeCardSpec tiledOnly = gpuCard();
  tiledOnly.planeModifiers = {kTiled};
  FakeCardSpec refusing = gpuCard();
  refusing.refusesGpuTests = true;
  const std::array<Case, 3> cases{Case{"no GPU", {}}, Case{"no common layout", tiledOnly, kLinear},
                                  Case{"TEST_ONLY refuses", refusing}};
  for (const Case& each : cases) {
    FakeCardSpec spec = each.spec;
    spec.node = std::string("/dev/dri/card") + std::to_string(&each - cases.data());
    support::FakeCards cards(clock_);
    cards.add(spec);
    output_ = *openDisplay("display", {}, cards, clock_);
    ASSERT_TRUE(output_->start({.size = kSize, .framePeriod = {}}));
    const auto lent = output_->lendToGpu(each.modifiers, kCount);
    ASSERT_FALSE(lent.has_value()) << each.what;
    EXPECT_EQ(lent.error().kind, each.kind) << each.what << ": " << lent.error().message();
    EXPECT_EQ(cards.gpuBuffers, 0) << each.what;
    // The others go on.
    EXPECT_TRUE(output_->acquire()->has_value()) << each.what;
    output_.reset();
  }
}

TEST_F(GpuSurfaces, LeaveNothingBehindWhereTheSecondHasNoMemory) {
  FakeCardSpec spec = gpuCard();
  constexpr std::size_t kBytes = (64 * 4 + 64) * 48;
  spec.memoryBytes = 4 * kBytes + kBytes / 2;
  plug(spec);
  ASSERT_TRUE(start());
  const auto lent = output_->lendToGpu(kDrawn, kCount);
  ASSERT_FALSE(lent.has_value());
  EXPECT_EQ(lent.error().kind, ErrorKind::kNoSpace) << lent.error().message();
  EXPECT_EQ(cards_.gpuBuffers, 0);
  ASSERT_TRUE(showAndWait());
  EXPECT_EQ(cards_.shown.back().firstPixel, kPainted);
}

TEST_F(GpuSurfaces, AreFreedOnceNobodyDrawsIntoThem) {
  plug(gpuCard());
  ASSERT_TRUE(start());
  lend();
  ASSERT_TRUE(showDrawn());
  EXPECT_EQ(cards_.gpuBuffers, static_cast<int>(kCount));
  output_->endLending();
  EXPECT_EQ(cards_.gpuBuffers, 1) << "the one that is shown";
  ASSERT_TRUE(showAndWait());
  ASSERT_TRUE(showAndWait());
  EXPECT_EQ(cards_.gpuBuffers, 0);
}

TEST_F(GpuSurfaces, EndWithTheCardThatTheyAreLentBy) {
  FakeCardSpec& spec = plug(gpuCard());
  ASSERT_TRUE(start());
  lend();
  const SurfaceId id = **output_->acquireForGpu();
  spec.isGone = true;
  const auto next = output_->acquireForGpu();
  ASSERT_FALSE(next.has_value());
  EXPECT_EQ(next.error().kind, ErrorKind::kDeviceLost);
  output_->release(of(id).surface);
  output_.reset();
  EXPECT_EQ(cards_.gpuBuffers, 0);
}

TEST_F(GpuSurfaces, EndOnceAFlipIsRefusedAfterAll) {
  FakeCardSpec& spec = plug(gpuCard());
  ASSERT_TRUE(start());
  lend();
  spec.refusesGpuFlips = true;
  ASSERT_TRUE(showDrawn());
  ASSERT_EQ(events_.size(), 1u);
  EXPECT_EQ(events_.front().result, PresentationEvent::Result::kSkipped);
  const auto next = output_->acquireForGpu();
  ASSERT_FALSE(next.has_value());
  EXPECT_EQ(next.error().kind, ErrorKind::kUnsupported);
  EXPECT_EQ(cards_.gpuBuffers, 0);
  ASSERT_TRUE(showAndWait()) << "the display itself goes on";
}

TEST_F(GpuSurfaces, StayOnTheScreenWhereOthersTakeTheirPlace) {
  plug(gpuCard());
  ASSERT_TRUE(start());
  lend();
  ASSERT_TRUE(showDrawn(7));
  lend();
  EXPECT_EQ(cards_.gpuBuffers, static_cast<int>(kCount) + 1)
      << "the one that is shown is still there";
  ASSERT_TRUE(showDrawn(8));
  lend(kDrawn, 1);
  EXPECT_EQ(cards_.gpuBuffers, 2);
}

TEST_F(GpuSurfaces, AreGoneAfterAnotherStreamIsTaken) {
  plug(gpuCard());
  ASSERT_TRUE(start());
  lend();
  ASSERT_TRUE(output_->reconfigure({.size = {32, 32}, .framePeriod = {}}).has_value());
  EXPECT_EQ(cards_.gpuBuffers, 0);
  EXPECT_EQ(*output_->acquireForGpu(), std::nullopt);
}

TEST_F(GpuSurfaces, AreBlackenedWhereTheDisplayIsSwitchedOff) {
  FakeCardSpec& spec = plug(gpuCard());
  ASSERT_TRUE(start("display", {.blanking = {.after = std::chrono::seconds(2)}}));
  lend();
  ASSERT_TRUE(showDrawn());
  EXPECT_EQ(spec.firstPixel(), kPainted);
  ASSERT_TRUE(runTo(clock_.now() + std::chrono::seconds(4)));
  ASSERT_FALSE(spec.isOn);
  EXPECT_EQ(*output_->acquireForGpu(), std::nullopt);
  output_->noteActivity();
  ASSERT_TRUE(runTo(clock_.now() + std::chrono::seconds(1)));
  ASSERT_TRUE(spec.isOn);
  EXPECT_EQ(spec.firstPixel(), 0u);
}

TEST_F(GpuSurfaces, WaitForTheirFenceInTheCardWhereItCan) {
  for (const bool waits : {true, false}) {
    support::FakeCards cards(clock_);
    FakeCardSpec spec = gpuCard();
    spec.waitsForFences = waits;
    cards.add(spec);
    output_ = *openDisplay("display", {}, cards, clock_);
    ASSERT_TRUE(output_->start({.size = kSize, .framePeriod = {}}));
    lend();
    std::array<int, 2> pipe{};
    ASSERT_EQ(::pipe(pipe.data()), 0);
    ASSERT_TRUE(showDrawn(kPainted, Fence(pipe[0])));
    EXPECT_TRUE(cards.shown.empty()) << "before its fence";
    EXPECT_EQ(cards.flipsWithFence, waits ? 1 : 0);
    ASSERT_EQ(::write(pipe[1], "x", 1), 1);
    ASSERT_TRUE(runTo(clock_.now() + 3 * period_));
    EXPECT_EQ(cards.shown.size(), 1u);
    ::close(pipe[1]);
    output_.reset();
  }
}

/// IN_FORMATS as a kernel makes it.
std::vector<std::uint8_t> inFormats(std::span<const std::uint32_t> fourccs,
                                    std::span<const drm_format_modifier> modifiers) {
  drm_format_modifier_blob head{};
  head.version = FORMAT_BLOB_CURRENT;
  head.count_formats = static_cast<std::uint32_t>(fourccs.size());
  head.formats_offset = sizeof(head);
  head.count_modifiers = static_cast<std::uint32_t>(modifiers.size());
  head.modifiers_offset =
      static_cast<std::uint32_t>(sizeof(head) + (fourccs.size_bytes() + 7) / 8 * 8);
  std::vector<std::uint8_t> bytes(head.modifiers_offset + modifiers.size_bytes());
  std::memcpy(bytes.data(), &head, sizeof(head));
  std::memcpy(bytes.data() + head.formats_offset, fourccs.data(), fourccs.size_bytes());
  std::memcpy(bytes.data() + head.modifiers_offset, modifiers.data(), modifiers.size_bytes());
  return bytes;
}

TEST(ModifiersIn, AreThoseOfTheFormatOnly) {
  const std::array<std::uint32_t, 3> fourccs{kArgb8888, kXbgr8888, kXrgb8888};
  const std::array<drm_format_modifier, 3> entries{
      drm_format_modifier{.formats = 0b111, .offset = 0, .pad = 0, .modifier = kLinearModifier},
      drm_format_modifier{.formats = 0b011, .offset = 0, .pad = 0, .modifier = kOther},
      drm_format_modifier{.formats = 0b1, .offset = 2, .pad = 0, .modifier = kTiled}};
  const std::vector<std::uint8_t> bytes = inFormats(fourccs, entries);
  EXPECT_EQ(display::modifiersIn(bytes, kXrgb8888), (std::vector{kLinearModifier, kTiled}));
  EXPECT_EQ(display::modifiersIn(bytes, kXbgr8888), (std::vector{kLinearModifier, kOther}));
}

TEST(ModifiersIn, AreNoneInWhatIsNoSuchList) {
  const std::array<std::uint32_t, 1> fourccs{kXrgb8888};
  const std::array<drm_format_modifier, 1> entries{
      drm_format_modifier{.formats = 1, .offset = 0, .pad = 0, .modifier = kTiled}};
  const std::vector<std::uint8_t> bytes = inFormats(fourccs, entries);
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    EXPECT_TRUE(display::modifiersIn(std::span(bytes).first(length), kXrgb8888).empty()) << length;
  }
  std::vector<std::uint8_t> wild = bytes;
  std::ranges::fill(wild, std::uint8_t{0xFF});
  EXPECT_TRUE(display::modifiersIn(wild, kXrgb8888).empty());
}

}  // namespace
}  // namespace pleinair::hal
