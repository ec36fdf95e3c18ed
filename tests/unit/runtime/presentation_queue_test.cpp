#include "pipeline/runtime/output/presentation_queue.h"

#include <gtest/gtest.h>

namespace pleinair::runtime {
namespace {

using namespace std::chrono_literals;

constexpr hal::TimePoint kStart{1h};

hal::TimePoint at(hal::Duration time) {
  return kStart + time;
}

/// A frame that was captured 100 ms before its due time.
WaitingFrame frame(hal::Duration ready, hal::Duration due) {
  return {
      .buffer = 0, .ticket = {}, .captured = at(due - 100ms), .ready = at(ready), .due = at(due)};
}

class PresentationQueueTest : public testing::Test {
 protected:
  /// The outcome of the frame that next() decides on now, if any.
  std::optional<Outcome> outcomeAt(hal::Duration now) {
    const auto decision = queue_.next(at(now));
    return decision ? std::optional(decision->outcome) : std::nullopt;
  }
  /// Shows a frame now, so that no freeze is imminent.
  void showOneAt(hal::Duration now) {
    queue_.push(frame(now, now));
    ASSERT_EQ(outcomeAt(now), Outcome::kShown);
  }

  PresentationQueue queue_{{}, 4};
};

TEST(DueTime, IsTheFirstRefreshAtOrAfterTheLatency) {
  const hal::Refresh refresh{.period = 16ms, .phase = at(5ms)};
  EXPECT_EQ(dueTime(at(0ms), 100ms, std::nullopt), at(100ms));
  EXPECT_EQ(dueTime(at(0ms), 101ms, refresh), at(101ms)) << "exactly on one";
  EXPECT_EQ(dueTime(at(0ms), 102ms, refresh), at(117ms));
  EXPECT_EQ(dueTime(at(-500ms), 0ms, refresh), at(-491ms)) << "before the phase";
  EXPECT_EQ(dueTime(at(0ms), 102ms, hal::Refresh{.period = 16ms, .phase = {}}), at(102ms))
      << "where the phase is not known";
}

TEST_F(PresentationQueueTest, LetsEarlyPicturesWait) {
  queue_.push(frame(20ms, 100ms));
  EXPECT_EQ(queue_.nextTime(), at(100ms));
  EXPECT_EQ(outcomeAt(99ms), std::nullopt);
  EXPECT_EQ(outcomeAt(100ms), Outcome::kShown);
  EXPECT_EQ(queue_.nextTime(), std::nullopt);
}

TEST_F(PresentationQueueTest, DropsWhatWasReadyTooLate) {
  showOneAt(60ms);
  queue_.push(frame(110ms, 100ms));
  EXPECT_EQ(outcomeAt(110ms), Outcome::kLate);
}

TEST_F(PresentationQueueTest, ToleratesAWakingThatIsALittleLate) {
  showOneAt(0ms);
  queue_.push(frame(50ms, 100ms));
  EXPECT_EQ(outcomeAt(107ms), Outcome::kShown);
}

TEST_F(PresentationQueueTest, ShowsALatePictureRatherThanFreeze) {
  showOneAt(0ms);
  queue_.push(frame(180ms, 130ms));  // 180 ms after the one before: the next comes after 360
  EXPECT_EQ(outcomeAt(180ms), Outcome::kShownOffSchedule);
  queue_.push(frame(230ms, 190ms));  // 50 ms after it: the next one comes before 200 ms are over
  EXPECT_EQ(outcomeAt(230ms), Outcome::kLate);
}

TEST_F(PresentationQueueTest, ShowsTheVeryFirstPictureHoweverLate) {
  queue_.push(frame(900ms, 100ms));
  EXPECT_EQ(outcomeAt(900ms), Outcome::kShownOffSchedule);
}

TEST_F(PresentationQueueTest, ShowsTheNewestOfThoseDue) {
  showOneAt(0ms);
  queue_.push(frame(20ms, 100ms));
  queue_.push(frame(30ms, 102ms));
  queue_.push(frame(40ms, 140ms));
  EXPECT_EQ(outcomeAt(103ms), Outcome::kSuperseded);
  EXPECT_EQ(outcomeAt(103ms), Outcome::kShown);
  EXPECT_EQ(outcomeAt(103ms), std::nullopt);
}

TEST_F(PresentationQueueTest, AttributesTheOutputForWhatFellDueWhileItWasBusy) {
  showOneAt(0ms);
  queue_.push(frame(20ms, 30ms));
  queue_.push(frame(40ms, 60ms));
  queue_.push(frame(60ms, 90ms));
  queue_.presented(at(80ms));
  EXPECT_EQ(outcomeAt(80ms), Outcome::kOutputBusy);
  EXPECT_EQ(outcomeAt(80ms), Outcome::kOutputBusy) << "20 ms late";
  EXPECT_EQ(outcomeAt(90ms), Outcome::kShown);
}

TEST_F(PresentationQueueTest, KeepsTheOrderWhenTheLatencyFalls) {
  queue_.push({.captured = at(0ms), .ready = at(20ms), .due = at(200ms)});
  queue_.push({.captured = at(30ms), .ready = at(50ms), .due = at(130ms)});
  EXPECT_EQ(outcomeAt(130ms), std::nullopt);
  EXPECT_EQ(outcomeAt(200ms), Outcome::kSuperseded);
  EXPECT_EQ(outcomeAt(200ms), Outcome::kShown);
}

TEST(UnpacedQueue, HandsOnEachPictureAtOnce) {
  PresentationQueue queue({.isPaced = false}, 4);
  queue.push(frame(20ms, 10ms));
  queue.push(frame(30ms, 500ms));
  EXPECT_EQ(queue.nextTime(), at(20ms));
  EXPECT_EQ(queue.next(at(600ms))->outcome, Outcome::kShown);
  EXPECT_EQ(queue.next(at(600ms))->outcome, Outcome::kShown);
}

}  // namespace
}  // namespace pleinair::runtime
