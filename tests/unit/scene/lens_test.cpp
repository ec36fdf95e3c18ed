#include "pipeline/scene/description/lens.h"

#include <gtest/gtest.h>

namespace pleinair::scene {
namespace {

TEST(Lens, BendsLinesWithAnyTerm) {
  EXPECT_FALSE(bendsLines({}));
  EXPECT_TRUE(bendsLines({.p2 = 1e-4}));
  EXPECT_TRUE(bendsLines({.k6 = 1e-4}));
}

TEST(Lens, IsTrustedUntilItsRadiusFoldsBack) {
  EXPECT_EQ(trustedLensRadius({}), kMaxTrustedRadius);
  EXPECT_EQ(trustedLensRadius({.k1 = 0.2}), kMaxTrustedRadius);
  // r (1 − 0.3 r²) turns at r = 1 / √0.9
  EXPECT_NEAR(trustedLensRadius({.k1 = -0.3}), 1.05, 0.04);
  // a denominator that falls to 0 at r = 1
  EXPECT_LT(trustedLensRadius({.k4 = -1.0}), 1.0);
}

}  // namespace
}  // namespace pleinair::scene
