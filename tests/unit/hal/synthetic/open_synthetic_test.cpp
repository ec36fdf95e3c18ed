#include "hal/cameras/synthetic/open_synthetic.h"

#include <string>

#include <gtest/gtest.h>

namespace pleinair::hal {
namespace {

TEST(SyntheticShotOf, ReadsEveryShotsName) {
  EXPECT_EQ(**syntheticShotOf("synthetic", "--camera"), SyntheticShot::kWalkaround);
  for (int i = 0; i <= static_cast<int>(SyntheticShot::kCut); ++i) {
    const auto shot = static_cast<SyntheticShot>(i);
    const std::string name(toString(shot));
    EXPECT_EQ(**syntheticShotOf("synthetic:" + name, "--camera"), shot) << name;
    EXPECT_NE(syntheticShotNames().find(name), std::string::npos);
  }
}

TEST(SyntheticShotOf, LeavesOtherCamerasAlone) {
  for (const char* name : {"", "webcam", "synthetics", "/dev/video0", "recording:synthetic:pan"}) {
    const auto shot = syntheticShotOf(name, "--camera");
    ASSERT_TRUE(shot) << name;
    EXPECT_FALSE(*shot) << name;
  }
}

TEST(SyntheticShotOf, RefusesUnknownShotsWithTheList) {
  for (const char* name : {"synthetic:", "synthetic:zoom", "synthetic:Pan", "synthetic:pan "}) {
    const auto shot = syntheticShotOf(name, "--camera");
    ASSERT_FALSE(shot) << name;
    EXPECT_EQ(shot.error().kind, ErrorKind::kInvalidArgument);
  }
  EXPECT_EQ(syntheticShotOf("synthetic:zoom", "--camera").error().message(),
            "--camera: the synthetic camera has no shot \"zoom\"; allowed: walkaround, pan, dolly, "
            "roll, still, occluder, cut");
}

}  // namespace
}  // namespace pleinair::hal
