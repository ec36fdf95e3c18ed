#include "pipeline/measure/input/kitti_flow.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/media/png_file.h"
#include "tests/support/deep_png.h"
#include "tests/support/temporary_folder.h"

namespace pleinair::measure {
namespace {

using support::constantFlow;
using support::Rgb16Png;
using testing::HasSubstr;

const cv::Size kSize(200, 180);

class KittiFlow : public testing::Test {
 protected:
  std::filesystem::path path(const std::string& name) const { return folder_.path() / name; }

  std::filesystem::path mask(const std::string& name, cv::Rect hidden, cv::Size size = kSize) {
    hal::Image image({.pixelFormat = hal::PixelFormat::kGrey8,
                      .size = {size.width, size.height},
                      .encoding = {}});
    for (int y = hidden.y; y < hidden.br().y; ++y) {
      for (int x = hidden.x; x < hidden.br().x; ++x) {
        image.row(0, y)[static_cast<std::size_t>(x)] = 255;
      }
    }
    hal::orThrow(hal::writePng(path(name), image.view()));
    return path(name);
  }

  support::TemporaryFolder folder_;
};

TEST_F(KittiFlow, IsReadToThe64thOfAPixel) {
  Rgb16Png png = constantFlow(kSize.width, kSize.height, 0, 0);
  png.set(7, 9, {32768 - 160, 32768 + 1, 1});
  png.set(8, 9, {40000, 40000, 0});
  png.write(path("flow.png"));
  const hal::Result<KittiFlowField> field = readKittiFlow(path("flow.png"), kSize);
  ASSERT_TRUE(field) << field.error().message();
  EXPECT_EQ(field->px(9, 7), cv::Vec2f(-2.5F, 1.0F / 64));
  EXPECT_EQ(field->px(20, 20), cv::Vec2f(0, 0));
  EXPECT_EQ(field->seen(9, 8), 0);
  EXPECT_EQ(cv::countNonZero(field->seen), kSize.area() - 1);
}

TEST_F(KittiFlow, OfAnotherSizeOrDepthIsRefusedInALine) {
  constantFlow(20, 10, 0, 0).write(path("small.png"));
  EXPECT_THAT(readKittiFlow(path("small.png"), kSize).error().message(),
              testing::AllOf(HasSubstr("small.png"), HasSubstr("20x10"), HasSubstr("200x180")));
  mask("shallow.png", {});
  EXPECT_THAT(readKittiFlow(path("shallow.png"), kSize).error().message(), HasSubstr("16-bit"));
  Rgb16Png(kSize.width, kSize.height).write(path("empty.png"));
  EXPECT_THAT(readKittiFlow(path("empty.png"), kSize).error().message(), HasSubstr("valid"));
  EXPECT_THAT(readKittiFlow(path("absent.png"), kSize).error().message(), HasSubstr("absent.png"));
}

TEST_F(KittiFlow, IsComposedOverFrames) {
  std::vector<std::filesystem::path> flows;
  for (int i = 0; i < 3; ++i) {
    flows.push_back(path("flow" + std::to_string(i) + ".png"));
    // Each flow is longer by half a pixel.
    constantFlow(kSize.width, kSize.height, 1 + 0.5 * i, -0.25).write(flows.back());
  }
  const auto motion = flowSequence(kSize, flows, {});
  const hal::Result<MotionMap> map = motion->between(0, 3);
  ASSERT_TRUE(map) << map.error().message();
  EXPECT_NE(map->valid(90, 100), 0);
  EXPECT_EQ(map->displacement(90, 100), cv::Vec2f(4.5F, -0.75F));
  EXPECT_EQ(motion->between(1, 2)->displacement(90, 100), cv::Vec2f(1.5F, -0.25F));
  // Flow that leaves the frame is invalid.
  EXPECT_EQ(map->valid(90, 198), 0);
}

TEST_F(KittiFlow, LeavesOutWhatIsHiddenInAnyFrameBetween) {
  std::vector<std::filesystem::path> flows, masks;
  for (int i = 0; i < 2; ++i) {
    flows.push_back(path("flow" + std::to_string(i) + ".png"));
    constantFlow(kSize.width, kSize.height, 10, 0).write(flows.back());
  }
  masks.push_back(mask("occ0.png", {}));
  masks.push_back(mask("occ1.png", {100, 80, 10, 10}));
  const auto motion = flowSequence(kSize, flows, masks);
  const hal::Result<MotionMap> map = motion->between(0, 2);
  ASSERT_TRUE(map) << map.error().message();
  EXPECT_EQ(map->valid(85, 95), 0);  // leads to (105, 85), which is hidden after that
  EXPECT_NE(map->valid(85, 120), 0);
  masks.back() = mask("occ-small.png", {}, {20, 10});
  EXPECT_THAT(flowSequence(kSize, flows, masks)->between(0, 2).error().message(),
              HasSubstr("occ-small.png"));
}

}  // namespace
}  // namespace pleinair::measure
