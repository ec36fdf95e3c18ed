#include "pipeline/measure/input/motion_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pleinair::measure {
namespace {

using testing::AllOf;
using testing::HasSubstr;

TEST(MotionFile, HasAVector) {
  const auto file = parseMotion(R"({"v": [-1.5, -0.5]})", "m");
  ASSERT_TRUE(file) << file.error().message();
  EXPECT_EQ(file->perFrame, cv::Point2d(-1.5, -0.5));
  const auto motion = motionOf(*file, {200, 200}, 1000, "m");
  ASSERT_TRUE(motion);
  EXPECT_EQ((*motion)->kind(), MotionKind::kPan);
}

TEST(MotionFile, OrHomographiesFromFrameToFrame) {
  const auto file =
      parseMotion(R"({"homographies": [[1,0,2, 0,1,3, 0,0,1], [2,0,0, 0,2,0, 0,0,1]]})", "m");
  ASSERT_TRUE(file) << file.error().message();
  const auto motion = motionOf(*file, {200, 200}, 3, "m");
  ASSERT_TRUE(motion);
  EXPECT_EQ((*motion)->kind(), MotionKind::kOther);
  const hal::Result<MotionMap> map = (*motion)->between(0, 2);
  ASSERT_TRUE(map);
  EXPECT_EQ(map->displacement(20, 10), cv::Vec2f(2 * 12 - 10, 2 * 23 - 20));
  EXPECT_THAT(motionOf(*file, {200, 200}, 4, "m").error().message(),
              AllOf(HasSubstr("2 homographies"), HasSubstr("4 frames")));
}

TEST(MotionFile, HasNoOtherKeys) {
  EXPECT_THAT(parseMotion(R"({"v": [1, 2], "note": 1})", "m").error().message(),
              AllOf(HasSubstr("\"note\": unknown key;"), HasSubstr("\"v\""),
                    HasSubstr("\"homographies\"")));
  EXPECT_THAT(parseMotion(R"({"homografies": []})", "m").error().message(),
              HasSubstr("did you mean \"homographies\"?"));
}

TEST(MotionFile, IsRefusedInALineThatSaysWhatIsAllowed) {
  for (const char* text :
       {"", "no json", "[1, 2]", "{}", R"({"v": 3})", R"({"v": [1]})", R"({"v": [1, 2, 3]})",
        R"({"v": ["a", 1]})", R"({"v": [1e9, 0]})", R"({"v": [1, null]})",
        R"({"v": [0, 0], "homographies": []})", R"({"homographies": []})",
        R"({"homographies": [[1, 2, 3]]})", R"({"homographies": [[0,0,0,0,0,0,0,0,0]]})"}) {
    const auto file = parseMotion(text, "here/motion.json");
    ASSERT_FALSE(file) << text;
    EXPECT_THAT(file.error().message(),
                AllOf(HasSubstr("here/motion.json"), HasSubstr("[vx, vy]")));
    EXPECT_EQ(file.error().message().find('\n'), std::string::npos);
  }
  EXPECT_THAT(readMotion("/no/such/motion.json").error().message(), HasSubstr("/no/such"));
}

}  // namespace
}  // namespace pleinair::measure
