#include "hal/media/errors.h"

#include <cerrno>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/media/handles.h"

namespace pleinair::hal::libav {
namespace {

TEST(LibavError, KeepsTheKindOfFailuresOfTheWorld) {
  EXPECT_EQ(libavError("a", "b", AVERROR(ENOSPC)).kind, ErrorKind::kNoSpace);
  EXPECT_EQ(libavError("a", "b", AVERROR(EIO)).kind, ErrorKind::kIo);
  const Error refused = libavError("a", "b", AVERROR_INVALIDDATA, ErrorKind::kUnsupported);
  EXPECT_EQ(refused.kind, ErrorKind::kUnsupported);
  EXPECT_EQ(refused.domain, ErrorDomain::kLibav);
  EXPECT_EQ(refused.code, AVERROR_INVALIDDATA);
  EXPECT_THAT(refused.message(), testing::StartsWith("a: b: Invalid data"));
}

TEST(LogCapture, TakesTheFirstErrorOfItsThreadAndPrintsNothing) {
  redirectLog();
  testing::internal::CaptureStderr();
  av_log(nullptr, AV_LOG_ERROR, "nobody listens\n");
  LogCapture outer;
  av_log(nullptr, AV_LOG_WARNING, "only a warning\n");
  EXPECT_EQ(outer.firstError(), "");
  av_log(nullptr, AV_LOG_ERROR, "first\x1b[31m\nsecond line\n");
  av_log(nullptr, AV_LOG_ERROR, "second\n");
  {
    const LogCapture inner;
    av_log(nullptr, AV_LOG_ERROR, "inner\n");
    EXPECT_EQ(inner.firstError(), "inner");
  }
  EXPECT_EQ(outer.firstError(), "first?[31m");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace pleinair::hal::libav
