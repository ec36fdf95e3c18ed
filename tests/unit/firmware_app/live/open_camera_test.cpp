#include "firmware_app/live/open_camera.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/error.h"
#include "tests/support/media_files.h"
#include "tests/support/temporary_folder.h"

namespace pleinair::app {
namespace {

using testing::HasSubstr;

TEST(OpenCamera, MakesTheSyntheticOneInTheSizeAskedFor) {
  hal::SteppedClock clock;
  const auto camera = openCamera({.size = {64, 48}}, clock);
  EXPECT_EQ(camera->identity().backend, "synthetic");
  const hal::StreamFormat format = hal::orThrow(camera->start({}));
  EXPECT_EQ(format.frame.size, (hal::FrameSize{64, 48}));
  EXPECT_FALSE(format.frameCount);
}

TEST(OpenCamera, PlaysRecordingsOverAndOverAtTheirOwnPace) {
  const support::TemporaryFolder folder;
  support::writeMedia(folder.path() / "a.mp4", 3);
  hal::SteppedClock clock;
  const auto camera = openCamera({.source = folder.path() / "a.mp4"}, clock);
  EXPECT_EQ(camera->identity().backend, "recording");
  const hal::TimePoint start = clock.now();
  ASSERT_TRUE(camera->start({}));
  for (int i = 0; i < 7; ++i) {
    const hal::NextFrame next = camera->next(hal::kNoDeadline);
    ASSERT_TRUE(std::holds_alternative<hal::CapturedFrame>(next)) << i;
    EXPECT_EQ(clock.now() - start, i * std::chrono::milliseconds(40)) << "real time";
  }
}

TEST(OpenCamera, RefusesOthersAndSaysWhatThereIs) {
  hal::SteppedClock clock;
  for (const std::string name : {"webcam", "/no-such-folder/a.mp4", "Synthetic"}) {
    try {
      openCamera({.source = name}, clock);
      ADD_FAILURE() << name;
    } catch (const hal::StartupError& error) {
      EXPECT_EQ(error.error().kind, hal::ErrorKind::kNotFound);
      EXPECT_THAT(error.what(), testing::StartsWith(name + ": is neither a camera nor a file"));
      EXPECT_THAT(error.what(), HasSubstr("choose synthetic, or the path of a recording"));
    }
  }
}

}  // namespace
}  // namespace pleinair::app
