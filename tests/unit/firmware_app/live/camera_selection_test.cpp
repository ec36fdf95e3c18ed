#include "firmware_app/config/camera_selection.h"

#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "firmware_app/config/configuration_sections.h"
#include "firmware_app/config/configured_parts.h"
#include "hal/cameras/recording/recording_kind.h"
#include "hal/cameras/registry.h"
#include "hal/cameras/synthetic/synthetic_kind.h"
#include "hal/error.h"
#include "tests/support/media_files.h"
#include "tests/support/temporary_folder.h"

namespace pleinair::app {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::StartsWith;

TEST(CameraSelection, MakesTheSyntheticOnesShotInTheSizeAskedFor) {
  hal::SteppedClock clock;
  const auto camera = chosenCamera({.source = "synthetic:pan", .size = {64, 48}}, clock);
  EXPECT_EQ(camera->identity().backend, "synthetic");
  EXPECT_THAT(camera->identity().id, StartsWith("synthetic:pan"));
  const hal::StreamFormat format = hal::orThrow(camera->start({}));
  EXPECT_EQ(format.frame.size, (hal::FrameSize{64, 48}));
  EXPECT_FALSE(format.frameCount);
}

TEST(CameraSelection, PlaysRecordingsOverAndOverAtTheirOwnPace) {
  const support::TemporaryFolder folder;
  support::writeMedia(folder.path() / "a.mp4", 3);
  hal::SteppedClock clock;
  const auto camera = chosenCamera({.source = folder.path() / "a.mp4"}, clock);
  EXPECT_EQ(camera->identity().backend, "recording");
  const hal::TimePoint start = clock.now();
  ASSERT_TRUE(camera->start({}));
  for (int i = 0; i < 7; ++i) {
    const hal::NextFrame next = camera->next(hal::kNoDeadline);
    ASSERT_TRUE(std::holds_alternative<hal::CapturedFrame>(next)) << i;
    EXPECT_EQ(clock.now() - start, i * std::chrono::milliseconds(40)) << "real time";
  }
}

/// The failure of choosing `source`.
hal::Error failureOf(const std::string& source) {
  hal::SteppedClock clock;
  try {
    chosenCamera({.source = source}, clock);
  } catch (const hal::Failure& error) {
    return error.error();
  }
  ADD_FAILURE() << source;
  return {};
}

TEST(CameraSelection, RefusesOthersAndSaysWhatThereIs) {
  for (const std::string source : {"webcam", "/no-such-folder/a.mp4", "Synthetic", "serial:"}) {
    const hal::Error error = failureOf(source);
    EXPECT_EQ(error.kind, hal::ErrorKind::kNotFound);
    EXPECT_THAT(error.message(), StartsWith(source + ": is neither a camera nor a file; choose "));
    EXPECT_THAT(error.message(), HasSubstr("auto, "));
    EXPECT_THAT(error.message(), HasSubstr("synthetic:pan"));
    EXPECT_THAT(error.message(), HasSubstr("serial:NUMBER, or the path of a recording"));
  }
}

TEST(CameraSelection, SaysThatNoDeviceHasTheSerialNumber) {
  const hal::Error error = failureOf("serial:no-device-has-this");
  EXPECT_EQ(error.kind, hal::ErrorKind::kNotFound);
  EXPECT_THAT(error.message(),
              StartsWith("serial:no-device-has-this: no camera with that serial "));
}

TEST(CameraSelection, EveryDeviceBackEndHasItsNames) {
  EXPECT_THAT(cameraNames(), Contains("auto"));
  for (const hal::SelectableBackend& each : deviceBackends()) {
    const std::string name(each.backend->name());
    EXPECT_TRUE(each.isDevice) << name;
    EXPECT_THAT(cameraNames(), Contains(name));
    EXPECT_THAT(openCameraNames(), Contains(name + ":ID"));
  }
}

TEST(CameraKinds, AreWhollyDescribedAndHaveEachATable) {
  std::set<std::string> names;
  const config::Sections sections = defaultSections();
  for (const hal::CameraKind* kind : hal::cameraKinds()) {
    EXPECT_TRUE(names.insert(std::string(kind->name)).second) << kind->name;
    EXPECT_FALSE(kind->help.empty()) << kind->name;
    EXPECT_EQ(sections.values("camera." + std::string(kind->name)), kind->defaults);
    const auto backend = kind->open(kind->defaults, {});
    EXPECT_EQ(backend->name(), kind->name);
    EXPECT_TRUE(backend->list()) << kind->name;
  }
  EXPECT_THAT(names, testing::IsSupersetOf({"recording", "synthetic", "v4l2"}));
}

TEST(CameraSelection, TakesWhatAKindsOwnTableSays) {
  hal::SteppedClock clock;
  const hal::CameraKind& synthetic = hal::synthetic::cameraKind();
  CameraSettings settings{.source = "synthetic", .size = {64, 48}};
  settings.tables.emplace(synthetic.name,
                          synthetic.defaults.with("shot", "roll").with("seed", "5"));
  EXPECT_EQ(chosenCamera(settings, clock)->identity().id, "synthetic:roll:5");
  settings.source = "synthetic:pan";
  EXPECT_EQ(chosenCamera(settings, clock)->identity().id, "synthetic:pan:5");
}

TEST(CameraSelection, PlaysARecordingOnceAndAtTheConfiguredRateOfItsPictures) {
  const support::TemporaryFolder folder;
  support::writeMedia(folder.path() / "%02d.png", 3);
  hal::SteppedClock clock;
  const hal::CameraKind& recording = hal::recording::cameraKind();
  CameraSettings settings{.source = folder.path()};
  settings.tables.emplace(recording.name,
                          recording.defaults.with("loop", "false").with("picture_rate", "10"));
  const auto camera = chosenCamera(settings, clock);
  const hal::TimePoint start = clock.now();
  ASSERT_TRUE(camera->start({}));
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(std::holds_alternative<hal::CapturedFrame>(camera->next(hal::kNoDeadline))) << i;
    EXPECT_EQ(clock.now() - start, i * std::chrono::milliseconds(100));
  }
  EXPECT_TRUE(std::holds_alternative<hal::EndOfStream>(camera->next(hal::kNoDeadline)));
}

TEST(CameraSelection, NamesAreNoPaths) {
  for (const std::string name : {"auto", "synthetic", "synthetic:pan", "serial:A/1"}) {
    EXPECT_TRUE(isCameraName(name)) << name;
    EXPECT_FALSE(isRecording({.source = name})) << name;
  }
  for (const std::string path : {"a.mp4", "./auto", "serial", "serial:", "synthetic:x"}) {
    EXPECT_FALSE(isCameraName(path)) << path;
  }
}

}  // namespace
}  // namespace pleinair::app
