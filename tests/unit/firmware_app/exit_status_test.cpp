#include "firmware_app/cli/exit_status.h"

#include <new>
#include <stdexcept>

#include <gtest/gtest.h>

#include "config/config_error.h"

namespace pleinair::app {
namespace {

using hal::ErrorDomain;
using hal::ErrorKind;

/// The printed message of an exception, and the exit status.
template <class Exception>
std::pair<std::string, ExitStatus> reported(const Exception& exception) {
  testing::internal::CaptureStderr();
  ExitStatus status = ExitStatus::kSuccess;
  try {
    throw exception;
  } catch (...) {
    status = reportCurrentException();
  }
  return {testing::internal::GetCapturedStderr(), status};
}

TEST(ExitStatus, Is2WhereTheCallerCanMendIt) {
  for (const ErrorKind kind :
       {ErrorKind::kInvalidArgument, ErrorKind::kInvalidInput, ErrorKind::kUnsupported,
        ErrorKind::kNotFound, ErrorKind::kPermissionDenied, ErrorKind::kNoSpace}) {
    EXPECT_EQ(exitStatusOf({.kind = kind}), ExitStatus::kUsage) << static_cast<int>(kind);
    EXPECT_EQ(exitStatusOf({.kind = kind, .domain = ErrorDomain::kErrno}), ExitStatus::kUsage);
    EXPECT_EQ(exitStatusOf({.kind = kind, .domain = ErrorDomain::kLibav}), ExitStatus::kUsage);
  }
}

TEST(ExitStatus, Is1ForDevicesAndOurselves) {
  for (const ErrorKind kind : {ErrorKind::kBusy, ErrorKind::kTimeout, ErrorKind::kDeviceLost,
                               ErrorKind::kIo, ErrorKind::kInternal}) {
    EXPECT_EQ(exitStatusOf({.kind = kind}), ExitStatus::kInternal) << static_cast<int>(kind);
  }
}

TEST(ExitStatus, Is1ForTheGpuWhateverItLacks) {
  for (const ErrorDomain domain : {ErrorDomain::kEgl, ErrorDomain::kGl}) {
    EXPECT_EQ(exitStatusOf({.kind = ErrorKind::kUnsupported, .domain = domain}),
              ExitStatus::kInternal);
  }
}

TEST(ExitStatus, Is2ForAShaderThatTheCallerGave) {
  for (const ErrorKind kind : {ErrorKind::kInvalidInput, ErrorKind::kNotFound}) {
    EXPECT_EQ(exitStatusOf({.kind = kind, .domain = ErrorDomain::kGl}), ExitStatus::kUsage);
  }
}

TEST(ReportCurrentException, PrintsOneLine) {
  const hal::Error error{.kind = ErrorKind::kNotFound,
                         .subject = "in\n\x1b[2J.mp4",
                         .problem = "cannot open",
                         .remedy = "look for it"};
  EXPECT_EQ(reported(hal::Failure(error)),
            std::pair(std::string("pleinair: in??[2J.mp4: cannot open; look for it\n"),
                      ExitStatus::kUsage));
  const config::ConfigError config(
      {.file = "scene.toml", .line = 3, .key = "tag[0].id", .problem = "missing"});
  EXPECT_EQ(reported(config),
            std::pair(std::string("pleinair: ") + config.what() + "\n", ExitStatus::kUsage));
  EXPECT_EQ(reported(std::runtime_error("no idea")),
            std::pair(std::string("pleinair: internal error: no idea\n"), ExitStatus::kInternal));
  EXPECT_EQ(reported(std::bad_alloc()),
            std::pair(std::string("pleinair: out of memory\n"), ExitStatus::kInternal));
}

}  // namespace
}  // namespace pleinair::app
