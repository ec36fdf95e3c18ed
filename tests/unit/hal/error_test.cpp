#include "hal/error.h"

#include <cerrno>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pleinair::hal {
namespace {

TEST(Error, ReadsAsOneLine) {
  const Error error{.kind = ErrorKind::kInvalidInput,
                    .subject = "in.mp4",
                    .problem = "holds no video",
                    .remedy = "give a movie with a video track"};
  EXPECT_EQ(error.message(), "in.mp4: holds no video; give a movie with a video track");
  EXPECT_EQ((Error{.problem = "just this"}).message(), "just this");
}

TEST(Error, TakesKindAndTextFromErrno) {
  const Error full = errnoError("out.mp4", "cannot write", ENOSPC);
  EXPECT_EQ(full.kind, ErrorKind::kNoSpace);
  EXPECT_EQ(full.code, ENOSPC);
  EXPECT_THAT(full.message(), testing::HasSubstr("out.mp4: cannot write: No space left"));
  EXPECT_EQ(errnoError("", "", ENOENT).kind, ErrorKind::kNotFound);
  EXPECT_EQ(errnoError("", "", EACCES).kind, ErrorKind::kPermissionDenied);
  EXPECT_EQ(errnoError("", "", ELOOP).kind, ErrorKind::kInvalidArgument);
  EXPECT_EQ(errnoError("", "", EIO).kind, ErrorKind::kIo);
}

TEST(Error, BecomesAnExceptionAtStartUp) {
  EXPECT_EQ(orThrow(Result<int>(3)), 3);
  try {
    orThrow(Result<int>(tl::unexpected(errnoError("x", "cannot open", ENOENT))));
    FAIL();
  } catch (const Failure& error) {
    EXPECT_EQ(error.error().kind, ErrorKind::kNotFound);
    EXPECT_THAT(error.what(), testing::StartsWith("x: cannot open"));
  }
}

}  // namespace
}  // namespace pleinair::hal
