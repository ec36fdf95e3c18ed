#pragma once

// The contract of hal/camera.h, run against every camera. A backend's test file includes this and
// says INSTANTIATE_TEST_SUITE_P(Name, CameraConformance, testing::Values(CameraCase{...}),
// cameraCaseName) in namespace pleinair::hal::conformance.

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <ostream>
#include <string>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "hal/camera.h"
#include "hal/image.h"

namespace pleinair::hal::conformance {

/// One camera under test.
struct CameraCase {
  std::string name;  ///< letters and digits
  std::function<std::unique_ptr<Camera>(Clock&)> make;
  std::string backend;  ///< expected identity().backend
  /// Frames until EndOfStream; 0: it goes on for ever.
  std::uint64_t frames = 0;
  /// Whether its frames come in real time, whatever the clock of the test says.
  bool isLive = false;
  /// Whether its link drops what a busy machine does not fetch in time, as UDP does: such frames
  /// say that they are invalid, and are the fewer.
  bool mayLosePackets = false;
};

inline void PrintTo(const CameraCase& camera, std::ostream* out) {
  *out << camera.name;
}
inline std::string cameraCaseName(const testing::TestParamInfo<CameraCase>& info) {
  return info.param.name;
}

class CameraConformance : public testing::TestWithParam<CameraCase> {
 protected:
  /// Frames that an endless camera is asked for.
  static constexpr std::uint64_t kEnoughFrames = 8;

  static std::uint64_t framesToAskFor() {
    return GetParam().frames == 0 ? kEnoughFrames : GetParam().frames;
  }
  std::unique_ptr<Camera> make() { return GetParam().make(clock_); }

  /// How much later than its deadline a camera may answer, which shows in real time only.
  static constexpr Duration kLiveSlack = std::chrono::milliseconds(500);

  void pause() {
    if (!GetParam().isLive) stepped_.advance(std::chrono::seconds(5));
  }

  static StreamFormat startOrFail(Camera& camera, const StreamRequest& request = {}) {
    Result<StreamFormat> format = camera.start(request);
    EXPECT_TRUE(format.has_value()) << (format ? "" : format.error().message());
    return format.value_or(StreamFormat{});
  }

  /// The next frame, with format changes taken note of; nothing at the end or on a failure.
  static std::optional<CapturedFrame> nextFrame(Camera& camera, StreamFormat& format) {
    for (;;) {
      NextFrame next = camera.next(kNoDeadline);
      if (auto* changed = std::get_if<FormatChanged>(&next)) {
        format = changed->format;
        continue;
      }
      if (auto* frame = std::get_if<CapturedFrame>(&next)) return std::move(*frame);
      EXPECT_TRUE(std::holds_alternative<EndOfStream>(next)) << "variant " << next.index();
      return std::nullopt;
    }
  }

  static std::vector<CapturedFrame> frames(Camera& camera, StreamFormat format,
                                           std::uint64_t count) {
    std::vector<CapturedFrame> taken;
    while (taken.size() < count) {
      std::optional<CapturedFrame> frame = nextFrame(camera, format);
      if (!frame) break;
      taken.push_back(*std::move(frame));
    }
    return taken;
  }

  static std::vector<std::uint8_t> bytesOf(const ImageView& view) {
    Image copy(view);
    std::vector<std::uint8_t> bytes;
    for (int plane = 0; plane < planeCount(view.format.pixelFormat); ++plane) {
      const auto span = copy.plane(plane);
      bytes.insert(bytes.end(), span.begin(), span.end());
    }
    return bytes;
  }

  SteppedClock stepped_{TimePoint(std::chrono::seconds(100))};
  SteadyClock steady_;
  Clock& clock_ = GetParam().isLive ? static_cast<Clock&>(steady_) : stepped_;
};

TEST_P(CameraConformance, SaysWhoItIs) {
  const std::unique_ptr<Camera> camera = make();
  const CameraIdentity before = camera->identity();
  EXPECT_EQ(before.backend, GetParam().backend);
  EXPECT_FALSE(before.id.empty());
  EXPECT_FALSE(before.description.empty());
  startOrFail(*camera);
  EXPECT_EQ(camera->identity().id, before.id);
}

TEST_P(CameraConformance, DeliversWhatWasNegotiated) {
  const std::unique_ptr<Camera> camera = make();
  StreamFormat format = startOrFail(*camera);
  EXPECT_TRUE(isAcceptedSize(format.frame.size));
  if (format.framePeriod) {
    EXPECT_GT(*format.framePeriod, Duration::zero());
  }
  std::uint64_t taken = 0;
  std::uint64_t damaged = 0;
  for (; taken < framesToAskFor(); ++taken) {
    const std::optional<CapturedFrame> frame = nextFrame(*camera, format);
    if (!frame) break;
    EXPECT_EQ(frame->image.format, format.frame);
    EXPECT_TRUE(frame->image.isComplete());
    if (frame->health != FrameHealth::kValid) ++damaged;
    EXPECT_NE(frame->lease, nullptr);
  }
  EXPECT_EQ(taken, framesToAskFor());
  EXPECT_LE(damaged, GetParam().mayLosePackets ? taken / 2 : 0);
}

TEST_P(CameraConformance, TellsWhereItsFramesLie) {
  const std::unique_ptr<Camera> camera = make();
  const StreamFormat format = startOrFail(*camera);
  std::map<std::uint32_t, std::array<DmaBufPlane, 3>> places;  // by buffer
  std::uint64_t pool = 0;
  std::uint64_t taken = 0;
  StreamFormat now = format;
  for (; taken < framesToAskFor(); ++taken) {
    const std::optional<CapturedFrame> frame = nextFrame(*camera, now);
    if (!frame) break;
    const int planes = planeCount(frame->image.format.pixelFormat);
    for (int i = 0; i < planes; ++i) {
      const DmaBufPlane& plane = frame->dmaBufs.at(static_cast<std::size_t>(i));
      EXPECT_EQ(plane.fd >= 0, static_cast<bool>(frame->buffer)) << "plane " << i;
      if (plane.fd < 0) continue;
      EXPECT_EQ(plane.strideBytes, frame->image.strideBytes(i)) << "plane " << i;
    }
    if (!frame->buffer) continue;
    EXPECT_NE(format.memory, FrameMemory::kProcessor);
    if (pool == 0) pool = frame->buffer.pool;
    EXPECT_EQ(frame->buffer.pool, pool) << "one pool a stream";
    const auto known = places.try_emplace(frame->buffer.index, frame->dmaBufs).first;
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(known->second.at(i).fd, frame->dmaBufs.at(i).fd) << "a buffer stays where it is";
    }
  }
  EXPECT_EQ(taken, framesToAskFor());
  camera->stop();
  now = startOrFail(*camera);
  if (const auto again = nextFrame(*camera, now); again && again->buffer) {
    EXPECT_NE(again->buffer.pool, pool) << "numbers of pools are used once";
  }
}

TEST_P(CameraConformance, MapsAFrameAsOftenAsWanted) {
  const std::unique_ptr<Camera> camera = make();
  StreamFormat format = startOrFail(*camera);
  const std::optional<CapturedFrame> frame = nextFrame(*camera, format);
  ASSERT_TRUE(frame);
  const std::vector<std::uint8_t> once = bytesOf(frame->image.map().view());
  const FrameMapping outer = frame->image.map();
  EXPECT_EQ(bytesOf(frame->image.map().view()), once);
  EXPECT_EQ(bytesOf(outer.view()), once);
  EXPECT_TRUE(outer.view().isComplete());
}

TEST_P(CameraConformance, MakesASecondImageOfEveryFrameOrOfNone) {
  std::unique_ptr<Camera> camera = make();
  constexpr int kSidePx = 16;
  const StreamFormat format = startOrFail(*camera, {.lumaSidePx = kSidePx});
  if (format.luma) {
    EXPECT_EQ(format.luma->pixelFormat, PixelFormat::kGrey8);
    EXPECT_LT(format.luma->size.pixels(), format.frame.size.pixels());
  }
  const std::vector<CapturedFrame> taken = frames(*camera, format, framesToAskFor());
  EXPECT_EQ(taken.size(), framesToAskFor());
  std::vector<std::vector<std::uint8_t>> before;
  for (const CapturedFrame& frame : taken) {
    EXPECT_EQ(frame.luma.has_value(), format.luma.has_value());
    if (!frame.luma) continue;
    EXPECT_EQ(frame.luma->format, *format.luma);
    ASSERT_TRUE(frame.luma->isComplete());
    before.push_back(bytesOf(frame.luma->map().view()));
  }
  // It is leased with its frame.
  camera.reset();
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_TRUE(bytesOf(taken[i].luma->map().view()) == before[i]);
  }
}

TEST_P(CameraConformance, CountsAndTimesRise) {
  const std::unique_ptr<Camera> camera = make();
  const TimePoint before = clock_.now();
  const StreamFormat format = startOrFail(*camera);
  const std::vector<CapturedFrame> taken = frames(*camera, format, framesToAskFor());
  ASSERT_EQ(taken.size(), framesToAskFor());
  EXPECT_EQ(taken.front().sequence, taken.front().droppedBefore);
  EXPECT_GE(taken.front().captureTime, before);
  for (std::size_t i = 1; i < taken.size(); ++i) {
    EXPECT_EQ(taken[i].sequence, taken[i - 1].sequence + 1 + taken[i].droppedBefore);
    EXPECT_GT(taken[i].captureTime, taken[i - 1].captureTime);
    EXPECT_EQ(taken[i].timestampSource, taken[0].timestampSource);
  }
}

TEST_P(CameraConformance, WaitsForNoFrameBeyondTheDeadline) {
  const std::unique_ptr<Camera> camera = make();
  startOrFail(*camera);
  std::uint64_t taken = 0;
  const Duration slack = GetParam().isLive ? kLiveSlack : Duration::zero();
  // Each wait ends at its deadline, and frames come all the same in time.
  for (int i = 0; i < 5000 && taken < framesToAskFor(); ++i) {
    const TimePoint deadline = clock_.now() + std::chrono::milliseconds(1);
    const NextFrame next = camera->next(deadline);
    EXPECT_LE(clock_.now(), deadline + slack);
    if (std::holds_alternative<CapturedFrame>(next)) ++taken;
    if (std::holds_alternative<CameraTimeout>(next)) {
      EXPECT_GE(clock_.now(), deadline) << "a timeout before its time";
    }
  }
  EXPECT_EQ(taken, framesToAskFor());
}

TEST_P(CameraConformance, DoesNotWaitAtAllForADeadlineThatHasPassed) {
  const std::unique_ptr<Camera> camera = make();
  startOrFail(*camera);
  const TimePoint now = clock_.now();
  for (int i = 0; i < 3; ++i) camera->next(now - std::chrono::seconds(1));
  EXPECT_LE(clock_.now(), now + (GetParam().isLive ? kLiveSlack : Duration::zero()));
}

TEST_P(CameraConformance, StartsAgainAsOftenAsWanted) {
  const std::unique_ptr<Camera> camera = make();
  for (int cycle = 0; cycle < 3; ++cycle) {
    const TimePoint before = clock_.now();
    const StreamFormat format = startOrFail(*camera);
    const std::vector<CapturedFrame> taken = frames(*camera, format, 1);
    ASSERT_EQ(taken.size(), 1u);
    EXPECT_EQ(taken[0].sequence, taken[0].droppedBefore) << "counts from 0 after each start";
    EXPECT_GE(taken[0].captureTime, before);
    camera->stop();
    camera->stop();  // idempotent
    pause();
  }
}

TEST_P(CameraConformance, GivesTheSamePicturesAfterARestart) {
  if (GetParam().backend != "recording" && GetParam().backend != "synthetic") {
    GTEST_SKIP() << "a live camera sees something new each time";
  }
  const std::unique_ptr<Camera> camera = make();
  std::vector<std::vector<std::uint8_t>> first;
  for (int cycle = 0; cycle < 2; ++cycle) {
    const TimePoint start = clock_.now();
    const StreamFormat format = startOrFail(*camera);
    const std::vector<CapturedFrame> taken = frames(*camera, format, framesToAskFor());
    for (std::size_t i = 0; i < taken.size(); ++i) {
      std::vector<std::uint8_t> bytes = bytesOf(taken[i].image.map().view());
      const Duration time = taken[i].captureTime - start;
      for (int shift = 0; shift < 64; shift += 8) {
        bytes.push_back(static_cast<std::uint8_t>(time.count() >> shift & 0xFF));
      }
      if (cycle == 0) {
        first.push_back(std::move(bytes));
      } else {
        ASSERT_LT(i, first.size());
        EXPECT_TRUE(bytes == first[i]) << "frame " << i << " or its time differs";
      }
    }
    EXPECT_EQ(taken.size(), first.size());
    camera->stop();
  }
}

TEST_P(CameraConformance, LendsFramesThatOutliveStopAndCamera) {
  std::unique_ptr<Camera> camera = make();
  const StreamFormat format = startOrFail(*camera);
  std::vector<CapturedFrame> taken = frames(*camera, format, 2);
  ASSERT_FALSE(taken.empty());
  std::vector<std::vector<std::uint8_t>> before;
  for (const CapturedFrame& frame : taken) before.push_back(bytesOf(frame.image.map().view()));
  camera->stop();
  for (std::size_t i = 0; i < taken.size(); ++i)
    EXPECT_TRUE(bytesOf(taken[i].image.map().view()) == before[i]);
  camera.reset();
  for (std::size_t i = 0; i < taken.size(); ++i)
    EXPECT_TRUE(bytesOf(taken[i].image.map().view()) == before[i]);
}

TEST_P(CameraConformance, TakesLeasesBackFromAnyThreadWhileItStreams) {
  const std::unique_ptr<Camera> camera = make();
  StreamFormat format = startOrFail(*camera);
  std::uint64_t taken = 0;
  for (; taken < framesToAskFor(); ++taken) {
    std::optional<CapturedFrame> frame = nextFrame(*camera, format);
    if (!frame) break;
    std::thread([dropped = *std::move(frame)]() mutable { dropped = {}; }).join();
  }
  EXPECT_EQ(taken, framesToAskFor());
}

TEST_P(CameraConformance, KeepsSayingThatItHasEnded) {
  if (GetParam().frames == 0) GTEST_SKIP() << "this camera goes on for ever";
  const std::unique_ptr<Camera> camera = make();
  const StreamFormat format = startOrFail(*camera);
  EXPECT_EQ(frames(*camera, format, GetParam().frames + 1).size(), GetParam().frames);
  for (int i = 0; i < 3; ++i) {
    const NextFrame next = camera->next(kNoDeadline);
    ASSERT_TRUE(std::holds_alternative<EndOfStream>(next));
    EXPECT_FALSE(std::get<EndOfStream>(next).truncated) << "a whole recording is not truncated";
  }
  if (format.frameCount) {
    EXPECT_EQ(*format.frameCount, GetParam().frames);
  }
}

TEST_P(CameraConformance, IsDestroyedInAnyState) {
  make();
  const std::unique_ptr<Camera> stopped = make();
  startOrFail(*stopped);
  stopped->stop();
  const std::unique_ptr<Camera> streaming = make();
  const StreamFormat format = startOrFail(*streaming);
  EXPECT_EQ(frames(*streaming, format, 1).size(), 1u);
}

TEST_P(CameraConformance, AnswersARequestItCannotMeetWithWhatItDoes) {
  const std::unique_ptr<Camera> camera = make();
  const Result<StreamFormat> format =
      camera->start({.size = FrameSize{17, 11}, .pixelFormat = PixelFormat::kBayerBggr8});
  if (!format) {  // refusing is allowed, in one clear line
    EXPECT_FALSE(format.error().message().empty());
    return;
  }
  const std::vector<CapturedFrame> taken = frames(*camera, *format, 1);
  ASSERT_EQ(taken.size(), 1u);
  EXPECT_EQ(taken[0].image.format, format->frame);
}

}  // namespace pleinair::hal::conformance
