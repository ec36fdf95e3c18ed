#include "hal/cameras/synthetic/synthetic_kind.h"

#include <string>

#include <gtest/gtest.h>

namespace pleinair::hal {
namespace {

TEST(SyntheticKind, ItsDefaultsAreTheCamerasOwn) {
  const CameraKind& kind = synthetic::cameraKind();
  const SyntheticOptions options =
      synthetic::optionsOf(kind.defaults, {.pacing = Pacing::kStepped});
  const SyntheticOptions own;
  EXPECT_EQ(options.size, own.size);
  EXPECT_EQ(options.framePeriod, own.framePeriod);
  EXPECT_EQ(options.shot, own.shot);
  EXPECT_EQ(options.seed, own.seed);
  EXPECT_EQ(options.noiseSigma, own.noiseSigma);
  EXPECT_EQ(options.exposureDriftStops, own.exposureDriftStops);
  EXPECT_EQ(options.whiteBalanceDrift, own.whiteBalanceDrift);
  EXPECT_EQ(options.rowTime, own.rowTime);
  EXPECT_EQ(options.pacing, own.pacing);
}

TEST(SyntheticKind, ListsEveryShotTheConfiguredOneFirst) {
  const CameraKind& kind = synthetic::cameraKind();
  const auto backend = kind.open(kind.defaults.with("shot", "roll"), {});
  const auto cameras = backend->list();
  ASSERT_TRUE(cameras);
  ASSERT_EQ(cameras->size(), syntheticShots().size());
  EXPECT_EQ(cameras->front().identity.id, "roll");
  SteppedClock clock;
  for (const CameraDescription& each : *cameras) {
    EXPECT_EQ(backend->make(each.identity.id, clock)->identity().id,
              "synthetic:" + each.identity.id + ":1");
    EXPECT_NE(syntheticShotNames().find(each.identity.id), std::string::npos);
  }
}

TEST(SyntheticKind, RefusesUnknownShotsWithTheList) {
  const CameraKind& kind = synthetic::cameraKind();
  SteppedClock clock;
  for (const char* name : {"", "zoom", "Pan", "pan "}) {
    const auto format = kind.open(kind.defaults, {})->make(name, clock)->start({});
    ASSERT_FALSE(format) << name;
    EXPECT_EQ(format.error().kind, ErrorKind::kInvalidArgument);
    EXPECT_EQ(format.error().message(), "synthetic:" + std::string(name) +
                                            ": the synthetic camera has no shot \"" + name +
                                            "\"; allowed: walkaround, pan, dolly, roll, still, "
                                            "occluder, cut, visitors, lights, hand, crossing, "
                                            "portrait");
  }
}

}  // namespace
}  // namespace pleinair::hal
