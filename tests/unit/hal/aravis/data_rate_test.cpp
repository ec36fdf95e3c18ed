// A camera's whole data rate through Aravis. It depends on the machine's speed, so that no other
// test runs beside it.
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <variant>

#include <gtest/gtest.h>

#include "hal/cameras/aravis/aravis_camera.h"
#include "tests/support/gige_simulator.h"

namespace pleinair::hal::aravis {
namespace {

using namespace std::chrono_literals;

[[maybe_unused]] const bool kIsPrivateNetwork = support::enterPrivateNetwork();

/// A number from the environment, for measurements by hand.
int setting(const char* name, int otherwise) {
  const char* const text = std::getenv(name);  // NOLINT(concurrency-mt-unsafe): nobody sets it
  return text == nullptr ? otherwise : std::atoi(text);
}

/// Frames that are lost or not whole at 1280x720 RGB8: of 60 at 30 frames a second, or as
/// PLEINAIR_HD_FRAMES and PLEINAIR_HD_RATE say.
std::uint64_t lostOfHd(bool packetSocket) {
  const int frames = setting("PLEINAIR_HD_FRAMES", 60);
  const int rate = setting("PLEINAIR_HD_RATE", 30);
  SteadyClock clock;
  AravisCamera camera(
      "127.0.0.1",
      {.pixelFormat = "RGB8", .packetBytes = 1500, .packetSocket = packetSocket, .buffers = 16},
      systemLibrary(), clock);
  const auto stream =
      camera.start({.size = FrameSize{1280, 720}, .framePeriod = fromSeconds(1.0 / rate)});
  EXPECT_TRUE(stream) << stream.error().message();
  if (!stream) return 60;
  EXPECT_EQ(stream->warning, "");
  std::uint64_t lost = 0;
  const TimePoint begun = clock.now();
  for (int n = 0; n < frames; ++n) {
    const NextFrame next = camera.next(clock.now() + 2s);
    const auto* frame = std::get_if<CapturedFrame>(&next);
    if (frame != nullptr) lost += frame->droppedBefore;
    if (frame == nullptr || frame->health != FrameHealth::kValid) ++lost;
  }
  std::printf("%d frames in %.1f s, %ju lost\n", frames, toSeconds(clock.now() - begun),
              std::uintmax_t{lost});
  return lost;
}

TEST(AravisDataRate, LosesNothingOfHdAtThirtyFramesASecond) {
  const support::GigeSimulator simulator;
  if (!simulator.isRunning()) GTEST_SKIP() << "another program has UDP port 3956";
  constexpr std::size_t kEnough = 4'000'000;
  if (systemLibrary().grantedSocketBuffer(kEnough) < kEnough) {
    GTEST_SKIP() << "net.core.rmem_max is below 4 MB";
  }
  for (const bool packetSocket : {true, false}) {
    std::uint64_t lost = 1;
    // Other programs of the machine may starve sender and receiver alike.
    for (int attempt = 0; attempt < 3 && lost > 0; ++attempt) lost = lostOfHd(packetSocket);
    EXPECT_EQ(lost, 0u) << packetSocket;
  }
}

}  // namespace
}  // namespace pleinair::hal::aravis
