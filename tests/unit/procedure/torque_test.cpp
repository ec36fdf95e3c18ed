#include <gtest/gtest.h>

#include "pipeline/procedure/units.h"

namespace pleinair::procedure {
namespace {

TEST(Torque, IsReadWithItsUnitAndTolerance) {
  const auto plain = readTorque("25 Nm").torque;
  ASSERT_TRUE(plain);
  EXPECT_EQ(plain->newtonMetres, 25.0);
  EXPECT_EQ(plain->toleranceNewtonMetres, 0.0);
  const auto tight = readTorque("80 +- 5 cNm").torque;
  ASSERT_TRUE(tight);
  EXPECT_DOUBLE_EQ(tight->newtonMetres, 0.8);
  EXPECT_DOUBLE_EQ(tight->toleranceNewtonMetres, 0.05);
  EXPECT_DOUBLE_EQ(readTorque("2 ± 0.5 kgf m").torque->toleranceNewtonMetres, 0.5 * 9.80665);
  EXPECT_NEAR(readTorque("10 lbf ft").torque->newtonMetres, 13.5582, 1e-4);
  EXPECT_NEAR(readTorque("100 lbf in").torque->newtonMetres, 11.2985, 1e-4);
}

TEST(Torque, SaysWhatIsWrong) {
  EXPECT_EQ(readTorque("25").problem, "has no unit");
  EXPECT_EQ(readTorque("tight").problem, "is no number with a unit");
  EXPECT_EQ(readTorque("25 NM").problem, "has the unknown unit \"NM\" (did you mean \"Nm\"?)");
  EXPECT_EQ(readTorque("25 furlong").problem, "has the unknown unit \"furlong\"");
  EXPECT_EQ(readTorque("25 ± Nm").problem, "has no number after ±");
  EXPECT_EQ(readTorque("0 Nm").problem, "is not above 0 and up to 1000 kNm");
  EXPECT_EQ(readTorque("5 ± 6 Nm").problem,
            "has a tolerance that is not from 0 to below its value");
}

}  // namespace
}  // namespace pleinair::procedure
