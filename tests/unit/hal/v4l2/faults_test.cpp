// Faults of drivers, and the camera's answers.
#include "tests/unit/hal/v4l2/fake_camera.h"

namespace pleinair::hal::v4l2 {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class V4l2Faults : public FakeCamera {};

TEST_F(V4l2Faults, AFlaggedFrameIsCorruptAndTheNextOneSound) {
  plug({.frames = {{1, {.addedFlags = V4L2_BUF_FLAG_ERROR}}}});
  startOrFail();
  EXPECT_EQ(frameOrFail().health, FrameHealth::kValid);
  EXPECT_EQ(frameOrFail().health, FrameHealth::kCorrupt);
  EXPECT_EQ(frameOrFail().health, FrameHealth::kValid);
}

TEST_F(V4l2Faults, AShortFrameIsIncomplete) {
  // 64x48 YUYV: 128 bytes per row. The last row may lack its padding.
  constexpr std::uint32_t kNeeded = (128 + 16) * 47 + 128;
  plug({.rowPadding = 16,
        .frames = {
            {0, {.bytesUsed = kNeeded}}, {1, {.bytesUsed = kNeeded - 1}}, {2, {.bytesUsed = 0}}}});
  startOrFail();
  EXPECT_EQ(frameOrFail().health, FrameHealth::kValid);
  const CapturedFrame shortFrame = frameOrFail();
  EXPECT_EQ(shortFrame.health, FrameHealth::kIncomplete);
  EXPECT_TRUE(shortFrame.image.isComplete()) << "whatever came, its memory can be read";
  EXPECT_EQ(frameOrFail().health, FrameHealth::kIncomplete);
}

TEST_F(V4l2Faults, ATimestampOfAnotherClockIsNotTrusted) {
  plug({.timestampFlags = V4L2_BUF_FLAG_TIMESTAMP_UNKNOWN, .frames = {{0, {.timestamp = 7s}}}});
  startOrFail();
  const CapturedFrame frame = frameOrFail();
  EXPECT_EQ(frame.timestampSource, TimestampSource::kArrival);
  EXPECT_EQ(frame.captureTime, clock_.now());
  EXPECT_EQ(frame.deviceTime, Duration(7s));
}

TEST_F(V4l2Faults, ATimestampThatGoesBackIsNotTrusted) {
  plug({.frames = {{1, {.timestamp = 50s}}}});
  startOrFail();
  const CapturedFrame first = frameOrFail();
  EXPECT_EQ(first.timestampSource, TimestampSource::kEndOfReadout);
  const CapturedFrame second = frameOrFail();
  EXPECT_EQ(second.timestampSource, TimestampSource::kArrival);
  EXPECT_EQ(second.captureTime, clock_.now());
  EXPECT_GT(second.captureTime, first.captureTime);
}

TEST_F(V4l2Faults, NothingBeforeTheDeadlineIsATimeoutAndNoEnd) {
  support::FakeVideo& video = plug({.stallsAt = 1});
  startOrFail();
  frameOrFail();
  const TimePoint deadline = clock_.now() + 300ms;
  EXPECT_TRUE(std::holds_alternative<CameraTimeout>(camera().next(deadline)));
  EXPECT_EQ(clock_.now(), deadline);
  video.stallsAt.reset();
  frameOrFail();
}

TEST_F(V4l2Faults, ReadyForNothingIsWaitedOut) {
  plug({.spuriousReadies = 5});
  startOrFail();
  const TimePoint before = clock_.now();
  expectPicture(frameOrFail(), 0);
  EXPECT_EQ(clock_.now(), before + 40ms);
}

TEST_F(V4l2Faults, ReadyForNothingForEverEndsAtTheDeadline) {
  plug({.stallsAt = 0, .spuriousReadies = 1'000'000});
  startOrFail();
  const TimePoint deadline = clock_.now() + 50ms;
  EXPECT_TRUE(std::holds_alternative<CameraTimeout>(camera().next(deadline)));
  EXPECT_EQ(clock_.now(), deadline);
}

class V4l2Unplugged : public V4l2Faults, public testing::WithParamInterface<int> {};

TEST_P(V4l2Unplugged, IsLostAndStaysSoUntilStop) {
  plug();
  startOrFail();
  const CapturedFrame kept = frameOrFail();
  kernel_.unplug(kNode, GetParam());
  for (int i = 0; i < 3; ++i) {
    const auto lost = answerOrFail<CameraLost>();
    EXPECT_EQ(lost.cause.kind, ErrorKind::kDeviceLost);
    EXPECT_EQ(lost.cause.code, GetParam());
    EXPECT_THAT(lost.cause.message(),
                AllOf(HasSubstr("/dev/video0: "), HasSubstr("; plug it in again")));
  }
  expectPicture(kept, 0);
  camera().stop();
  EXPECT_EQ(startError().kind, ErrorKind::kNotFound);
  plug();
  startOrFail();
  expectPicture(frameOrFail(), 0);
}

INSTANTIATE_TEST_SUITE_P(Errors, V4l2Unplugged, testing::Values(ENODEV, EINVAL, EIO, ENXIO),
                         [](const auto& each) { return std::to_string(each.param); });

TEST_F(V4l2Faults, AnUnknownFailureWhileStreamingIsAnError) {
  support::FakeVideo& video = plug();
  startOrFail();
  frameOrFail();
  video.failures[VIDIOC_DQBUF] = ENOMEM;
  for (int i = 0; i < 2; ++i) {
    EXPECT_THAT(answerOrFail<Error>().message(), HasSubstr("delivers no more frames"));
  }
}

TEST_F(V4l2Faults, ABufferThatIsNotTakenBackEndsTheStream) {
  support::FakeVideo& video = plug();
  startOrFail();
  frameOrFail();  // drops its lease
  video.failures[VIDIOC_QBUF] = ENODEV;
  EXPECT_THAT(answerOrFail<CameraLost>().cause.message(),
              HasSubstr("refuses to requeue its buffers"));
}

TEST_F(V4l2Faults, ASourceThatChangesIsNegotiatedAnew) {
  plug({.frames = {{2, {.changesSourceTo = FrameSize{32, 24}}}}});
  startOrFail();
  const CapturedFrame first = frameOrFail();
  frameOrFail();
  const auto changed = answerOrFail<FormatChanged>();
  EXPECT_EQ(changed.format.frame.size, (FrameSize{32, 24}));
  const CapturedFrame next = frameOrFail();
  EXPECT_EQ(next.image.format, changed.format.frame);
  EXPECT_EQ(next.sequence, 2u) << "it counts on";
  EXPECT_GT(next.captureTime, first.captureTime);
  expectPicture(next, 0);
  expectPicture(first, 0);
}

TEST_F(V4l2Faults, ASourceThatComesBackAsItWasIsNoChange) {
  plug({.frames = {{1, {.changesSourceTo = FrameSize{64, 48}}}}});
  startOrFail();
  frameOrFail();
  EXPECT_EQ(frameOrFail().sequence, 1u);
}

TEST_F(V4l2Faults, EventsWithoutEndEndNothing) {
  plug({.eventsNeverEnd = true, .frames = {{1, {.changesSourceTo = FrameSize{32, 24}}}}});
  startOrFail();
  frameOrFail();
  EXPECT_EQ(answerOrFail<FormatChanged>().format.frame.size, (FrameSize{32, 24}));
}

TEST_F(V4l2Faults, ASourceThatOnlyEverChangesIsAnError) {
  support::FakeVideo& video = plug();
  startOrFail();
  frameOrFail();
  video.failures[VIDIOC_DQBUF] = EPIPE;
  EXPECT_EQ(answerOrFail<Error>().code, EPIPE);
}

TEST_F(V4l2Faults, ASourceWhoseEventIsMissedIsFollowedAtItsLastBuffer) {
  plug({.frames = {{1, {.changesSourceTo = FrameSize{32, 24}}}},
        .failures = {{VIDIOC_SUBSCRIBE_EVENT, ENOTTY}}});
  startOrFail();
  frameOrFail();
  EXPECT_EQ(answerOrFail<FormatChanged>().format.frame.size, (FrameSize{32, 24}));
}

TEST_F(V4l2Faults, ASourceWithoutASignalIsLost) {
  support::FakeVideo& video = plug({.frames = {{1, {.changesSourceTo = FrameSize{32, 24}}}}});
  startOrFail();
  frameOrFail();
  video.failures[VIDIOC_QUERY_DV_TIMINGS] = ENOLINK;
  EXPECT_THAT(answerOrFail<CameraLost>().cause.message(), HasSubstr("no signal"));
}

struct StartFault {
  std::string name;
  unsigned long request;
  int errnoValue;
  ErrorKind kind;
  std::string text;
};

class V4l2StartFaults : public V4l2Faults, public testing::WithParamInterface<StartFault> {};

TEST_P(V4l2StartFaults, AreToldAndLeaveNothingBehind) {
  const StartFault& fault = GetParam();
  plug({.failures = {{fault.request, fault.errnoValue}}});
  const Error error = startError();
  EXPECT_EQ(error.kind, fault.kind) << error.message();
  EXPECT_EQ(error.subject, kNode);
  EXPECT_THAT(error.message(), HasSubstr(fault.text));
  expectNothingLeft();
  plug();
  startOrFail();
  frameOrFail();
}

constexpr unsigned long kMapFault = 0;  // of the fake

INSTANTIATE_TEST_SUITE_P(
    Requests, V4l2StartFaults,
    testing::Values(
        StartFault{"NoV4l2", VIDIOC_QUERYCAP, ENOTTY, ErrorKind::kUnsupported, "not a V4L2 device"},
        StartFault{"BusyFormat", VIDIOC_S_FMT, EBUSY, ErrorKind::kBusy, "end the program"},
        StartFault{"BusyBuffers", VIDIOC_REQBUFS, EBUSY, ErrorKind::kBusy, "end the program"},
        StartFault{"NoMemory", VIDIOC_REQBUFS, ENOMEM, ErrorKind::kIo, "allocate its buffers"},
        StartFault{"NoBuffer", VIDIOC_QUERYBUF, EINVAL, ErrorKind::kInvalidArgument, "its buffers"},
        StartFault{"NoMapping", kMapFault, EAGAIN, ErrorKind::kIo, "cannot map"},
        StartFault{"NoQueue", VIDIOC_QBUF, EIO, ErrorKind::kIo, "refuses to queue its buffers"},
        StartFault{"BusyStream", VIDIOC_STREAMON, EBUSY, ErrorKind::kBusy, "start streaming"},
        StartFault{"NoBandwidth", VIDIOC_STREAMON, ENOSPC, ErrorKind::kNoSpace, "start streaming"},
        StartFault{"NoFormats", VIDIOC_ENUM_FMT, EINVAL, ErrorKind::kUnsupported,
                   "offers no pixel format now"},
        StartFault{"NoSignal", VIDIOC_QUERY_DV_TIMINGS, ENOLINK, ErrorKind::kDeviceLost,
                   "no signal"}),
    [](const auto& each) { return each.param.name; });

TEST_F(V4l2Faults, ADeviceThatMayNotBeOpenedSaysWhatToDo) {
  plug({.openFailure = EACCES});
  const Error error = startError();
  EXPECT_EQ(error.kind, ErrorKind::kPermissionDenied);
  EXPECT_THAT(error.message(), HasSubstr("usermod -aG video"));
}

// The kernel asks for permission where a node is opened: an open stream goes on.
TEST_F(V4l2Faults, PermissionThatIsWithdrawnWhileStreamingIsMissedOnceItIsOpenedAgain) {
  plug().openFailure = EACCES;
  EXPECT_EQ(startError().kind, ErrorKind::kPermissionDenied);
  support::FakeVideo& video = plug();
  startOrFail();
  frameOrFail();
  video.openFailure = EACCES;
  frameOrFail();
  kernel_.unplug(kNode, ENODEV);
  answerOrFail<CameraLost>();
  camera().stop();
  plug({.openFailure = EACCES});
  EXPECT_THAT(startError().message(), HasSubstr("usermod -aG video"));
  expectNothingLeft();
  plug();
  startOrFail();
  frameOrFail();
}

TEST_F(V4l2Faults, ARequestThatIsForbiddenInMidStreamSaysSo) {
  support::FakeVideo& video = plug();
  startOrFail();
  frameOrFail();
  video.failures[VIDIOC_DQBUF] = EPERM;
  EXPECT_EQ(answerOrFail<Error>().kind, ErrorKind::kPermissionDenied);
}

TEST_F(V4l2Faults, ADeviceThatIsNotThereSaysSo) {
  EXPECT_EQ(startError().kind, ErrorKind::kNotFound);
}

TEST_F(V4l2Faults, AnOutputIsNoCamera) {
  plug({.caps = V4L2_CAP_VIDEO_OUTPUT | V4L2_CAP_STREAMING});
  EXPECT_THAT(startError().message(), HasSubstr("captures no video"));
}

TEST_F(V4l2Faults, ADeviceWithoutStreamingIsRefused) {
  plug({.caps = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_READWRITE});
  EXPECT_THAT(startError().message(), HasSubstr("no streaming I/O"));
}

TEST_F(V4l2Faults, OneBufferIsTooFew) {
  plug({.mostBuffers = 1});
  EXPECT_THAT(startError().message(), HasSubstr("gives only 1 buffer, at least 2 are needed"));
  expectNothingLeft();
}

TEST_F(V4l2Faults, NoBufferIsTooFew) {
  plug({.mostBuffers = 0});
  EXPECT_THAT(startError().message(), HasSubstr("gives only 0 buffers"));
}

TEST_F(V4l2Faults, BuffersTooSmallForTheFormatAreRefused) {
  plug({.missingBufferBytes = 1});
  EXPECT_THAT(startError().message(),
              HasSubstr("buffers of 6143 bytes, where its format needs 6144"));
  expectNothingLeft();
}

TEST_F(V4l2Faults, APlaneThatStartsOutsideItsBufferIsCorrupt) {
  plug({.caps = V4L2_CAP_VIDEO_CAPTURE_MPLANE | V4L2_CAP_STREAMING,
        .frames = {{0, {.dataOffset = 60}}, {1, {.dataOffset = 1'000'000}}}});
  startOrFail();
  const CapturedFrame shifted = frameOrFail();
  EXPECT_EQ(shifted.health, FrameHealth::kValid);
  expectPicture(shifted, 0);
  const CapturedFrame outside = frameOrFail();
  EXPECT_EQ(outside.health, FrameHealth::kCorrupt);
  EXPECT_TRUE(outside.image.isComplete());
}

}  // namespace
}  // namespace pleinair::hal::v4l2
