#include "hal/supervisor/camera_supervisor.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/hal/supervisor/supervised.h"

namespace pleinair::hal {
namespace {

using std::chrono::hours;
using std::chrono::milliseconds;
using std::chrono::seconds;
using support::scriptedError;
using support::ScriptedFrame;
using support::scriptedFrames;
using support::ScriptedJump;
using support::ScriptedSession;
using support::ScriptedSilence;
using support::scriptOf;
using testing::ElementsAre;
using testing::HasSubstr;

CameraLost unplugged() {
  return {scriptedError(ErrorKind::kDeviceLost, "was unplugged")};
}

ScriptedSession failing() {
  return {.startError = scriptedError(ErrorKind::kBusy, "is in use"), .steps = {}};
}

TEST(CameraSupervisor, OpensTellsTheFormatAndStreams) {
  Supervised supervised;
  supervised.add({{.steps = scriptedFrames(100)}});
  EXPECT_EQ(supervised.supervisor().state(), CameraState::kOpening);
  const auto all = supervised.run(milliseconds(100));
  EXPECT_THAT(story(all), ElementsAre("opening", "format", "streaming", "frames×3"));
  EXPECT_EQ(firstOf(all, "opening").reason, "opens usb");
  EXPECT_EQ(firstOf(all, "streaming").reason, "gave its first frame 33 ms after its start");
  EXPECT_EQ(supervised.supervisor().state(), CameraState::kStreaming);
  EXPECT_EQ(supervised.supervisor().status().camera->id, "a");
  expectLedgerOf(framesOf(all));
}

TEST(CameraSupervisor, OpensACameraAnewThatWasUnpluggedAndIsBack) {
  Supervised supervised;
  supervised.add({{.steps = scriptOf(scriptedFrames(3), unplugged())},
                  failing(),
                  {.steps = scriptedFrames(3)}});
  const auto all = supervised.run(seconds(1) + milliseconds(700));
  EXPECT_THAT(story(all),
              ElementsAre("opening", "format", "streaming", "frames×3", "lost", "backing off",
                          "opening", "lost", "backing off", "opening", "streaming", "frames×3"));
  EXPECT_EQ(firstOf(all, "lost").reason, "is gone: scripted: was unplugged");
  const auto frames = framesOf(all);
  expectLedgerOf(frames);
  EXPECT_EQ(frames.back().frame.sequence, 5U) << "no frames are made up for the time in between";
  const SupervisorCounts counts = supervised.supervisor().status().counts;
  EXPECT_EQ(counts.opens, 2U);
  EXPECT_EQ(counts.openFailures, 1U);
  EXPECT_EQ(counts.losses, 1U);
  EXPECT_EQ(counts.errors, 0U);
  EXPECT_EQ(counts.frames.delivered, 6U);
}

TEST(CameraSupervisor, GivesUpACameraThatStopsDeliveringWithoutAnError) {
  Supervised supervised;
  const auto device = supervised.add({{.steps = scriptedFrames(3)}, {.steps = scriptedFrames(3)}});
  const auto all = supervised.run(seconds(5));
  EXPECT_THAT(story(all),
              ElementsAre("opening", "format", "streaming", "frames×3", "stalled", "lost",
                          "backing off", "opening", "streaming", "frames×3", "stalled"));
  // 3 periods of 33 ms plus 200 ms after the last frame, within a poll interval of 50 ms.
  const Happened stalled = firstOf(all, "stalled");
  EXPECT_GE(stalled.at, milliseconds(99 + 299));
  EXPECT_LE(stalled.at, milliseconds(99 + 299 + 50));
  EXPECT_THAT(stalled.reason, HasSubstr("has given no frame for 3"));
  const Happened lost = firstOf(all, "lost");
  EXPECT_GE(lost.at - milliseconds(99), milliseconds(299) + seconds(3));
  EXPECT_LE(lost.at - milliseconds(99), milliseconds(349) + seconds(3));
  EXPECT_THAT(lost.reason, HasSubstr("has given no frame for 3.3 s; opens it anew"));
  EXPECT_EQ(device->starts, 2U);
}

TEST(CameraSupervisor, AStallThatEndsByItselfIsToldApartFromDrops) {
  Supervised supervised;
  ScriptedFrame dropping{.dropped = 2};
  ScriptedFrame back{.after = seconds(1), .dropped = 29, .underruns = 4};
  supervised.add({{.steps = scriptOf(scriptedFrames(3), dropping, back, scriptedFrames(2))}});
  const auto all = supervised.run(milliseconds(1300));
  EXPECT_THAT(story(all), ElementsAre("opening", "format", "streaming", "frames×4", "stalled",
                                      "streaming", "frames×3"));
  const auto frames = framesOf(all);
  expectLedgerOf(frames);
  EXPECT_EQ(frames[3].frame.droppedBefore, 2U);
  EXPECT_EQ(frames[3].lostInStall, 0U);
  EXPECT_EQ(frames[4].frame.droppedBefore, 29U);
  EXPECT_EQ(frames[4].frame.underrunsBefore, 4U);
  EXPECT_EQ(frames[4].lostInStall, 25U) << "the consumer lost the others";
  EXPECT_EQ(frames[5].lostInStall, 0U);
  const SupervisorCounts counts = supervised.supervisor().status().counts;
  EXPECT_EQ(counts.stalls, 1U);
  EXPECT_EQ(counts.resumptions, 1U);
  EXPECT_EQ(counts.losses, 0U);
  EXPECT_EQ(counts.frames,
            (FrameCounts{.delivered = 7, .dropped = 6, .underruns = 4, .lostInStall = 25}));
  EXPECT_THAT(supervised.supervisor().status().reason,
              HasSubstr("after 1.0 s of silence; 25 were lost"));
}

/// The time of each attempt to open.
std::vector<Duration> openingTimes(const std::vector<Happened>& all) {
  std::vector<Duration> times;
  for (const Happened& each : all) {
    if (each.what == "opening") times.push_back(each.at);
  }
  return times;
}

TEST(CameraSupervisor, BacksOffExactlyGrowingAndCapped) {
  Supervised supervised;
  supervised.add({failing(), failing(), failing(), failing(), failing(), failing(), {.steps = {}}});
  const auto all = supervised.run(seconds(24));
  EXPECT_THAT(openingTimes(all),
              ElementsAre(seconds(0), milliseconds(500), milliseconds(1500), milliseconds(3500),
                          milliseconds(7500), milliseconds(15500), milliseconds(23500)));
  EXPECT_EQ(firstOf(all, "lost").reason,
            "cannot open a camera: usb: no camera works: 1) scripted: "
            "is in use; plug one in, or choose another camera.source");
  EXPECT_EQ(firstOf(all, "backing off").reason, "opens again in 500 ms");
}

TEST(CameraSupervisor, StreamingForSecondsMakesTheNextBackOffTheFirst) {
  Supervised supervised;
  const auto shortly = scriptOf(scriptedFrames(3, milliseconds(100)), unplugged());
  const auto forLong = scriptOf(scriptedFrames(60, milliseconds(100)), unplugged());
  supervised.add({{.steps = shortly}, {.steps = shortly}, {.steps = forLong}, failing()});
  std::vector<std::string> waits;
  for (const Happened& each : supervised.run(seconds(9))) {
    if (each.what == "backing off") waits.push_back(each.reason);
  }
  EXPECT_THAT(waits, ElementsAre("opens again in 500 ms", "opens again in 1.0 s",
                                 "opens again in 500 ms", "opens again in 1.0 s"));
}

TEST(CameraSupervisor, AChangeOfDevicesCutsTheBackOffShort) {
  Supervised supervised;
  supervised.add({failing(), failing(), failing(), failing(), {.steps = scriptedFrames(100)}});
  supervised.run(milliseconds(4000));  // the fourth has failed at 3.5 s; the next would be at 7.5 s
  supervised.supervisor().devicesChanged();
  const auto all = supervised.run(seconds(1));
  EXPECT_EQ(firstOf(all, "opening").at, milliseconds(4100)) << "after the settling time";
  EXPECT_EQ(supervised.supervisor().state(), CameraState::kStreaming);
}

TEST(CameraSupervisor, AfterAChangeOfDevicesTheBackOffStartsSmall) {
  Supervised supervised;
  supervised.add({failing(), failing(), failing(), failing(), failing(), failing(), failing()});
  supervised.run(milliseconds(4000));
  supervised.supervisor().devicesChanged();
  EXPECT_THAT(openingTimes(supervised.run(seconds(2))),
              ElementsAre(milliseconds(4100), milliseconds(4600), milliseconds(5600)));
}

TEST(CameraSupervisor, ChangesOfDevicesDoNotDisturbAStreamNorCountLater) {
  Supervised supervised;
  supervised.add({{.steps = scriptOf(scriptedFrames(10), unplugged())}, {.steps = {}}});
  supervised.run(milliseconds(100));
  supervised.supervisor().devicesChanged();
  const auto all = supervised.run(seconds(1));
  EXPECT_EQ(firstOf(all, "opening").at - firstOf(all, "lost").at, milliseconds(500));
}

TEST(CameraSupervisor, TellsAFormatThatChangedAcrossOpenings) {
  Supervised supervised;
  const StreamFormat larger{.frame = support::scriptedFormat(16, 12),
                            .framePeriod = milliseconds(33)};
  supervised.add({{.steps = scriptOf(scriptedFrames(2), unplugged())},
                  {.format = larger, .steps = scriptedFrames(2)}});
  const auto all = supervised.run(milliseconds(700));
  EXPECT_THAT(story(all), ElementsAre("opening", "format", "streaming", "frames×2", "lost",
                                      "backing off", "opening", "format", "streaming", "frames×2"));
  EXPECT_EQ(framesOf(all).back().frame.image.format, larger.frame);
}

TEST(CameraSupervisor, TellsAFormatThatOnlyTheFrameTells) {
  Supervised supervised;
  supervised.add({{.steps = scriptOf(scriptedFrames(1),
                                     ScriptedFrame{.format = support::scriptedFormat(16, 12)})}});
  EXPECT_THAT(story(supervised.run(milliseconds(80))),
              ElementsAre("opening", "format", "streaming", "frames×1", "format", "frames×1"));
}

TEST(CameraSupervisor, GivesUpACameraThatNeverGivesAFirstFrame) {
  Supervised supervised;
  supervised.add({{.startTakes = milliseconds(700), .steps = {}}});
  const auto all = supervised.run(milliseconds(6300));
  EXPECT_THAT(story(all), ElementsAre("opening", "format", "lost", "backing off", "opening", "lost",
                                      "backing off"));
  EXPECT_EQ(firstOf(all, "lost").at, milliseconds(5700));
  EXPECT_EQ(firstOf(all, "lost").reason, "has given no frame for 5.0 s since its start");
}

TEST(CameraSupervisor, ACameraThatWaitsForATriggerIsNotSilent) {
  Supervised supervised;
  ScriptedSession triggered{.steps = scriptOf(ScriptedSilence{seconds(60)}, scriptedFrames(1),
                                              ScriptedSilence{seconds(60)}, unplugged())};
  triggered.format.framePeriod.reset();
  triggered.format.isTriggered = true;
  supervised.add({triggered});
  EXPECT_THAT(story(supervised.run(seconds(100))),
              ElementsAre("opening", "format", "streaming", "frames×1"));
  EXPECT_EQ(supervised.supervisor().status().counts.stalls, 0U);
  EXPECT_THAT(story(supervised.run(seconds(21))),
              ElementsAre("lost", "backing off", "opening", "lost", "backing off"));
}

TEST(CameraSupervisor, CountsCorruptAndMisTimedFramesAndLetsThemNotOut) {
  Supervised supervised;
  supervised.add(
      {{.steps = scriptOf(scriptedFrames(1), ScriptedFrame{.dropped = 1, .isTooShort = true},
                          ScriptedFrame{.timeError = -milliseconds(500)},  // earlier
                          ScriptedFrame{.timeError = seconds(3600)},       // in the future
                          ScriptedFrame{.dropped = 2},
                          ScriptedFrame{.after = Duration::zero()})}});  // the same time
  const auto all = supervised.run(milliseconds(250));
  const auto frames = framesOf(all);
  ASSERT_EQ(frames.size(), 2U);
  expectLedgerOf(frames);
  EXPECT_EQ(frames[1].corruptBefore, 1U);
  EXPECT_EQ(frames[1].misTimedBefore, 2U);
  EXPECT_EQ(frames[1].frame.droppedBefore, 3U);
  EXPECT_EQ(frames[1].frame.sequence, 7U);
  EXPECT_EQ(supervised.supervisor().status().counts.frames,
            (FrameCounts{.delivered = 2, .dropped = 3, .corrupt = 1, .misTimed = 3}));
}

TEST(CameraSupervisor, ACameraOfOnlyCorruptFramesIsStalledAndSaysSo) {
  Supervised supervised;
  const std::vector<support::ScriptedStep> corrupt(200, ScriptedFrame{.isTooShort = true});
  supervised.add({{.steps = scriptOf(scriptedFrames(2), corrupt)}});
  const auto all = supervised.run(seconds(4));
  EXPECT_THAT(firstOf(all, "stalled").reason,
              testing::MatchesRegex("has given no usable frame for 3[0-9]+ ms "
                                    "\\(1[0-9] corrupt, 0 incomplete, 0 with a wrong time\\)"));
  EXPECT_THAT(firstOf(all, "lost").reason, HasSubstr("no usable frame for 3.3 s"));
}

TEST(CameraSupervisor, FramesThatTheDeviceMarksAsUnusableAreRefusedAndCounted) {
  Supervised supervised;
  supervised.add(
      {{.steps = scriptOf(scriptedFrames(1), ScriptedFrame{.health = FrameHealth::kCorrupt},
                          ScriptedFrame{.health = FrameHealth::kIncomplete},
                          ScriptedFrame{.health = FrameHealth::kIncomplete}, scriptedFrames(1))}});
  const auto frames = framesOf(supervised.run(milliseconds(250)));
  ASSERT_EQ(frames.size(), 2U);
  expectLedgerOf(frames);
  EXPECT_EQ(frames[1].corruptBefore, 1U);
  EXPECT_EQ(frames[1].incompleteBefore, 2U);
  EXPECT_EQ(supervised.supervisor().status().counts.frames,
            (FrameCounts{.delivered = 2, .corrupt = 1, .incomplete = 2}));
}

TEST(CameraSupervisor, ACameraWhoseDriverMarksEachFrameCorruptIsStalledAndOpenedAnew) {
  Supervised supervised;
  const std::vector<support::ScriptedStep> corrupt(200,
                                                   ScriptedFrame{.health = FrameHealth::kCorrupt});
  supervised.add({{.steps = scriptOf(scriptedFrames(2), corrupt)}, {.steps = scriptedFrames(2)}});
  const auto all = supervised.run(seconds(5));
  EXPECT_THAT(firstOf(all, "stalled").reason,
              testing::ContainsRegex("1[0-9] corrupt, 0 incomplete"));
  EXPECT_THAT(firstOf(all, "lost").reason, HasSubstr("no usable frame for 3.3 s"));
  EXPECT_THAT(framesOf(all), testing::SizeIs(4)) << "of which the last two came anew";
}

TEST(CameraSupervisor, ACameraOfOnlyCorruptFramesFromItsStartNeverCountsAsStreaming) {
  Supervised supervised;
  const std::vector<support::ScriptedStep> corrupt(200,
                                                   ScriptedFrame{.health = FrameHealth::kCorrupt});
  supervised.add({{.steps = corrupt}});
  const auto all = supervised.run(milliseconds(5100));
  EXPECT_THAT(story(all), ElementsAre("opening", "format", "lost", "backing off"));
  EXPECT_THAT(firstOf(all, "lost").reason, HasSubstr("corrupt, 0 incomplete"));
}

TEST(CameraSupervisor, AJumpOfTheClockIsNoSilenceOfTheCamera) {
  Supervised supervised;
  supervised.add({{.steps = scriptOf(scriptedFrames(3), ScriptedJump{hours(1)}, scriptedFrames(3),
                                     ScriptedJump{hours(1)}, scriptedFrames(2))}});
  const auto all = supervised.run(hours(2) + milliseconds(300));
  EXPECT_THAT(story(all), ElementsAre("opening", "format", "streaming", "frames×8"));
  expectLedgerOf(framesOf(all));
}

TEST(CameraSupervisor, AJumpInAStallCountsOnceAndOnlyAsOneLook) {
  Supervised supervised;
  supervised.add({{.steps = scriptOf(scriptedFrames(2), ScriptedSilence{milliseconds(500)},
                                     ScriptedJump{hours(1)}, scriptedFrames(2))}});
  const auto all = supervised.run(hours(1) + seconds(1));
  EXPECT_EQ(supervised.supervisor().status().counts.stalls, 2U) << "the second: its script's end";
  EXPECT_EQ(supervised.supervisor().status().counts.losses, 0U);
  EXPECT_THAT(story(all), ElementsAre("opening", "format", "streaming", "frames×2", "stalled",
                                      "streaming", "frames×2", "stalled"));
}

TEST(CameraSupervisor, AConsumerThatWasAwayIsNoSilenceOfTheCamera) {
  Supervised supervised;
  supervised.add(
      {{.steps = scriptOf(scriptedFrames(2), ScriptedFrame{.after = milliseconds(900)})}});
  supervised.run(milliseconds(66));
  supervised.clock.advance(milliseconds(850));  // the painter is busy, and nothing polls the camera
  EXPECT_THAT(story(supervised.run(milliseconds(100))), ElementsAre("frames×1"));
}

TEST(CameraSupervisor, AnErrorIsALossThatIsCountedApart) {
  Supervised supervised;
  supervised.add({{.steps = scriptOf(scriptedFrames(1), scriptedError(ErrorKind::kIo, "EIO"))}});
  const auto all = supervised.run(milliseconds(200));
  EXPECT_EQ(firstOf(all, "lost").reason, "failed: scripted: EIO");
  EXPECT_EQ(supervised.supervisor().status().counts.errors, 1U);
  EXPECT_EQ(supervised.supervisor().status().counts.losses, 1U);
}

TEST(CameraSupervisor, TellsWithTheLossWhatWasItsCause) {
  Supervised supervised;
  SupervisedNext next = supervised.supervisor().next(TimePoint{});
  next = supervised.supervisor().next(TimePoint{});
  const auto* lost = std::get_if<CameraStateChanged>(&next);
  ASSERT_NE(lost, nullptr);
  ASSERT_TRUE(lost->cause);
  EXPECT_EQ(lost->cause->kind, ErrorKind::kNotFound);
  EXPECT_FALSE(lost->camera);
}

TEST(CameraSupervisor, ARecordingEndsAndIsNotWatched) {
  Supervised supervised;
  supervised.isDevice = false;
  supervised.add({{.steps = scriptOf(scriptedFrames(2), ScriptedSilence{seconds(60)},
                                     scriptedFrames(1), EndOfStream{})}});
  const auto all = supervised.run(seconds(70));
  EXPECT_THAT(story(all),
              ElementsAre("opening", "format", "streaming", "frames×3", "ended", "end"));
  EXPECT_EQ(firstOf(all, "ended").reason, "came to its end");
  EXPECT_TRUE(std::holds_alternative<EndOfStream>(supervised.supervisor().next(kNoDeadline)));
}

TEST(CameraSupervisor, ARecordingThatBreaksOffSaysWhy) {
  Supervised supervised;
  supervised.isDevice = false;
  supervised.add(
      {{.steps = scriptOf(scriptedFrames(1),
                          EndOfStream{scriptedError(ErrorKind::kInvalidInput, "is cut off")})}});
  EXPECT_EQ(firstOf(supervised.run(seconds(1)), "ended").reason, "broke off: scripted: is cut off");
  SupervisedNext next = supervised.supervisor().next(kNoDeadline);
  ASSERT_TRUE(std::holds_alternative<EndOfStream>(next));
  EXPECT_EQ(std::get<EndOfStream>(next).truncated->problem, "is cut off");
}

TEST(CameraSupervisor, ADeviceDoesNotEnd) {
  Supervised supervised;
  supervised.add({{.steps = scriptOf(scriptedFrames(1), EndOfStream{})}});
  EXPECT_EQ(firstOf(supervised.run(milliseconds(100)), "lost").reason, "ended its stream");
}

TEST(CameraSupervisor, WakeEndsAWaitOnce) {
  Supervised supervised;
  supervised.add({{.steps = {}}});
  supervised.run(milliseconds(10));
  supervised.supervisor().wake();
  EXPECT_TRUE(std::holds_alternative<CameraTimeout>(supervised.supervisor().next(kNoDeadline)));
  EXPECT_LE(supervised.clock.now().time_since_epoch(), milliseconds(60)) << "one look";
  EXPECT_TRUE(std::holds_alternative<CameraStateChanged>(supervised.supervisor().next(kNoDeadline)))
      << "it waits again, until the camera is given up";
}

TEST(CameraSupervisor, WakeEndsABackOffsWaitWithoutOpening) {
  Supervised supervised;
  supervised.run(milliseconds(2000));  // opened at 0, 0.5, 1.5 s
  supervised.supervisor().wake();
  EXPECT_TRUE(std::holds_alternative<CameraTimeout>(supervised.supervisor().next(kNoDeadline)));
  EXPECT_EQ(supervised.clock.now().time_since_epoch(), milliseconds(2000));
  EXPECT_EQ(supervised.supervisor().state(), CameraState::kBackingOff);
}

TEST(CameraSupervisor, StopsAtAnyMoment) {
  for (int steps = 0; steps < 40; ++steps) {
    Supervised supervised;
    const auto device = supervised.add({failing(),
                                        {.steps = scriptOf(scriptedFrames(3), unplugged())},
                                        {.steps = scriptOf(scriptedFrames(3))},
                                        failing()});
    for (int i = 0; i < steps; ++i) supervised.supervisor().next(kNoDeadline);
    const TimePoint before = supervised.clock.now();
    supervised.supervisor().stop();
    const auto all = supervised.run(seconds(1));
    ASSERT_GE(all.size(), 2U) << steps;
    EXPECT_EQ(all.back().what, "end") << steps;
    EXPECT_EQ(all[all.size() - 2].reason, "stopped by the program") << steps;
    EXPECT_EQ(supervised.clock.now(), before) << steps << ": without a wait";
    EXPECT_EQ(device->alive, 0) << steps;
    EXPECT_EQ(supervised.supervisor().state(), CameraState::kEnded);
  }
}

TEST(CameraSupervisor, ClosesTheCameraWhenDestroyed) {
  Supervised supervised;
  const auto device = supervised.add({{.steps = scriptedFrames(10)}});
  supervised.run(milliseconds(50));
  EXPECT_EQ(device->streaming, 1);
  supervised.destroy();
  EXPECT_EQ(device->alive, 0);
}

TEST(CameraSupervisor, LeaksNoCameraInAHundredLosses) {
  Supervised supervised;
  const auto device = supervised.add({{.steps = scriptOf(scriptedFrames(2), unplugged())}});
  device->repeatsLast = true;
  std::vector<SupervisedFrame> frames;
  for (int i = 0; i < 100; ++i) {
    while (supervised.supervisor().state() != CameraState::kBackingOff) {
      SupervisedNext next = supervised.supervisor().next(kNoDeadline);
      if (auto* frame = std::get_if<SupervisedFrame>(&next)) frames.push_back(std::move(*frame));
    }
    EXPECT_EQ(device->alive, 0) << i;
    while (supervised.supervisor().state() == CameraState::kBackingOff) {
      supervised.supervisor().next(kNoDeadline);
    }
  }
  EXPECT_EQ(supervised.supervisor().status().counts.losses, 100U);
  EXPECT_EQ(frames.size(), 200U);
  expectLedgerOf(frames);
}

TEST(CameraSupervisor, WithAChoiceOfCamerasPassesOverOneThatGivesNothing) {
  Supervised supervised("auto");
  const auto mute = supervised.add({{.steps = {}}}, "mute");
  mute->repeatsLast = true;
  const auto healthy = supervised.add({{.steps = scriptedFrames(1000)}}, "healthy");
  const auto all = supervised.run(seconds(8));
  EXPECT_EQ(supervised.supervisor().status().camera->id, "healthy");
  EXPECT_EQ(supervised.supervisor().state(), CameraState::kStreaming);
  EXPECT_EQ(mute->starts, 1U);
}

}  // namespace
}  // namespace pleinair::hal
