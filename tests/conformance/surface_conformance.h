#pragma once

// The contract of hal::SurfaceOutput (hal/output.h), run against every output that lends surfaces.
// A backend's test file includes this and says INSTANTIATE_TEST_SUITE_P(Name, SurfaceConformance,
// testing::Values(SurfaceCase{...}), surfaceCaseName) in namespace pleinair::hal::conformance.

#include <algorithm>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <ostream>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "hal/output.h"

namespace pleinair::hal::conformance {

/// One output under test.
struct SurfaceCase {
  std::string name;  ///< letters and digits
  /// Makes it; its time is the clock's.
  std::function<std::unique_ptr<Output>(Clock& clock)> make;
  std::string backend;      ///< expected identity().backend
  std::string missing;      ///< why it cannot be tried here; empty: it can
  bool hasOwnSize = false;  ///< it answers the display's size, whatever is requested
};

inline void PrintTo(const SurfaceCase& output, std::ostream* out) {
  *out << output.name;
}
inline std::string surfaceCaseName(const testing::TestParamInfo<SurfaceCase>& info) {
  return info.param.name;
}

class SurfaceConformance : public testing::TestWithParam<SurfaceCase> {
 protected:
  static constexpr FrameSize kSize{64, 48};

  void SetUp() override {
    if (!GetParam().missing.empty()) GTEST_SKIP() << GetParam().missing;
    output_ = GetParam().make(clock_);
    surfaces_ = output_->surfaces();
    ASSERT_NE(surfaces_, nullptr);
  }

  void start() {
    const Result<OutputFormat> format =
        output_->start({.size = kSize, .framePeriod = std::chrono::milliseconds(40)});
    ASSERT_TRUE(format.has_value()) << format.error().message();
    format_ = *format;
    if (format_.refresh) period_ = format_.refresh->period;
  }
  std::optional<Surface> acquire() {
    const auto surface = surfaces_->acquire();
    EXPECT_TRUE(surface.has_value()) << (surface ? "" : surface.error().message());
    return surface.value_or(std::nullopt);
  }
  void fill(const Surface& surface, std::uint8_t value) {
    const auto mapping = surfaces_->map(surface);
    ASSERT_TRUE(mapping.has_value()) << mapping.error().message();
    for (std::uint8_t& byte : mapping->plane(0)) byte = value;
  }
  /// Acquired, filled and submitted. False where none is free.
  bool show(TimePoint due) {
    const std::optional<Surface> surface = acquire();
    if (!surface) return false;
    fill(*surface, 128);
    const auto submitted = surfaces_->submit(*surface, Fence(), due);
    EXPECT_TRUE(submitted.has_value()) << (submitted ? "" : submitted.error().message());
    submitted_.push_back(surface->id);
    return true;
  }
  /// Until `time`, by way of every event.
  void runTo(TimePoint time) {
    while (clock_.now() < time) {
      const auto next = surfaces_->nextEvent();
      clock_.sleepUntil(next ? std::clamp(*next, clock_.now() + Duration{1}, time) : time);
      const auto taken = surfaces_->takeEvents(events_);
      ASSERT_TRUE(taken.has_value()) << taken.error().message();
    }
  }

  SteppedClock clock_{TimePoint(std::chrono::seconds(100))};
  std::unique_ptr<Output> output_;
  SurfaceOutput* surfaces_ = nullptr;
  OutputFormat format_;
  Duration period_ = std::chrono::milliseconds(17);
  std::vector<SurfaceId> submitted_;
  std::vector<PresentationEvent> events_;
};

TEST_P(SurfaceConformance, SaysWhoItIsAndTakesNoPicturesInMemory) {
  EXPECT_EQ(output_->identity().backend, GetParam().backend);
  EXPECT_FALSE(output_->identity().id.empty());
  EXPECT_EQ(output_->memory(), nullptr);
}

TEST_P(SurfaceConformance, AnswersAFormat) {
  start();
  EXPECT_TRUE(isAcceptedSize(format_.frame.size));
  if (!GetParam().hasOwnSize) {
    EXPECT_EQ(format_.frame.size, kSize);
  }
  if (format_.refresh) {
    EXPECT_GT(format_.refresh->period, Duration::zero());
  }
}

TEST_P(SurfaceConformance, RefusesASizeBeyondTheLimits) {
  const Result<OutputFormat> format = output_->start({.size = {8193, 4}});
  ASSERT_FALSE(format.has_value());
  EXPECT_EQ(format.error().kind, ErrorKind::kUnsupported);
}

TEST_P(SurfaceConformance, LendsSurfacesThatHoldAPictureAndKeepTheirIdentity) {
  start();
  std::set<SurfaceId> ids;
  std::vector<Surface> lent;
  while (const std::optional<Surface> surface = acquire()) {
    EXPECT_EQ(surface->format, format_.frame);
    EXPECT_TRUE(ids.insert(surface->id).second) << "lent twice";
    EXPECT_GE(surface->planes[0].dmaBuf, 0);
    const auto mapping = surfaces_->map(*surface);
    ASSERT_TRUE(mapping.has_value());
    const auto rows = static_cast<std::size_t>(format_.frame.size.height);
    EXPECT_GE(mapping->plane(0).size(), surface->planes[0].strideBytes * (rows - 1));
    lent.push_back(*surface);
    ASSERT_LE(lent.size(), 16u) << "they never run out";
  }
  EXPECT_GE(lent.size(), 2u);
  for (const Surface& each : lent) surfaces_->release(each);
  while (const std::optional<Surface> surface = acquire()) EXPECT_TRUE(ids.contains(surface->id));
}

TEST_P(SurfaceConformance, ShowsASurfaceAtTheRefreshNearestToItsDueTime) {
  start();
  for (int i = 0; i < 20; ++i) {
    const TimePoint due = clock_.now() + 3 * period_ + i * period_ / 20;
    ASSERT_TRUE(show(due));
    runTo(due + 2 * period_);
    ASSERT_EQ(events_.size(), static_cast<std::size_t>(i + 1));
    EXPECT_EQ(events_.back().surface, submitted_.back());
    EXPECT_EQ(events_.back().result, PresentationEvent::Result::kShown);
    EXPECT_LE(events_.back().time, due + period_ / 2);
    EXPECT_GE(events_.back().time, due - period_ / 2);
  }
}

TEST_P(SurfaceConformance, EndsEverySurfaceOnceInTheOrderOfSubmission) {
  start();
  for (int i = 0; i < 200; ++i) {
    show(clock_.now() + period_);  // where none is free, one is left out
    runTo(clock_.now() + period_ * (i % 3) / 2);
  }
  runTo(clock_.now() + 4 * period_);
  EXPECT_FALSE(surfaces_->nextEvent().has_value());
  ASSERT_EQ(events_.size(), submitted_.size());
  EXPECT_GT(events_.size(), 60u) << "surfaces do not come back";
  TimePoint last;
  std::optional<std::uint64_t> sequence;
  for (std::size_t i = 0; i < events_.size(); ++i) {
    EXPECT_EQ(events_[i].surface, submitted_[i]);
    if (events_[i].result != PresentationEvent::Result::kShown) continue;
    EXPECT_GT(events_[i].time, last);
    if (sequence && events_[i].sequence) {
      EXPECT_GT(*events_[i].sequence, *sequence);
    }
    last = events_[i].time;
    sequence = events_[i].sequence;
  }
}

TEST_P(SurfaceConformance, SupersedesASurfaceByALaterOneForTheSameRefresh) {
  start();
  const TimePoint due = clock_.now() + 2 * period_;
  ASSERT_TRUE(show(due));
  ASSERT_TRUE(show(due));
  runTo(due + 2 * period_);
  ASSERT_EQ(events_.size(), 2u);
  EXPECT_EQ(events_[0].result, PresentationEvent::Result::kSuperseded);
  EXPECT_EQ(events_[1].result, PresentationEvent::Result::kShown);
}

TEST_P(SurfaceConformance, TakesAnotherStreamAndGoesOn) {
  start();
  ASSERT_TRUE(show(clock_.now() + period_));
  runTo(clock_.now() + 2 * period_);
  ASSERT_TRUE(show(clock_.now() + 10 * period_));
  const FrameSize size{kSize.width / 2, kSize.height};
  const Result<OutputFormat> format = surfaces_->reconfigure({.size = size, .framePeriod = {}});
  ASSERT_TRUE(format.has_value()) << format.error().message();
  EXPECT_EQ(format->frame.pixelFormat, PixelFormat::kRgba8);
  if (!GetParam().hasOwnSize) {
    EXPECT_EQ(format->frame.size, size);
  }
  const auto surface = acquire();
  ASSERT_TRUE(surface.has_value());
  EXPECT_EQ(surface->format, format->frame);
  surfaces_->release(*surface);
  ASSERT_TRUE(show(clock_.now() + 2 * period_));
  runTo(clock_.now() + 5 * period_);
  ASSERT_EQ(events_.size(), 3u);
  EXPECT_EQ(events_[1].result, PresentationEvent::Result::kSkipped) << "the queued one";
  EXPECT_EQ(events_[2].result, PresentationEvent::Result::kShown);
}

TEST_P(SurfaceConformance, FinishesWithSurfacesLentQueuedAndShown) {
  start();
  ASSERT_TRUE(show(clock_.now() + period_));
  runTo(clock_.now() + 2 * period_);
  ASSERT_TRUE(show(clock_.now() + 10 * period_));
  acquire();
  const auto finished = output_->finish();
  EXPECT_TRUE(finished.has_value()) << finished.error().message();
}

TEST_P(SurfaceConformance, IsDestroyedInAnyState) {
  GetParam().make(clock_);
  start();
  acquire();
  show(clock_.now() + period_);
}

}  // namespace pleinair::hal::conformance
