// The style as a whole: repeatable, sized as asked for, and as new after a reset.
#include <gmock/gmock.h>

#include "tests/gpu/hatching/hatching_fixture.h"

namespace pleinair::styles {
namespace {

class HatchingStyle : public HatchingTest {
 protected:
  std::vector<std::uint8_t> drawn(Hatching& style, int frames) {
    restart();
    std::vector<std::uint8_t> bytes;
    for (int i = 0; i < frames; ++i) bytes = paint(style, next(2.0 * i, i == 0 ? 0.0 : 2.0));
    return bytes;
  }
};

TEST_F(HatchingStyle, SameFramesGiveTheSameBytes) {
  Hatching one(library_);
  Hatching other(library_);
  const auto first = drawn(one, 5);
  EXPECT_EQ(drawn(other, 5), first);
  Hatching third(library_);
  set(third, {{"seed", "2"}});
  EXPECT_NE(drawn(third, 5), first);
}

TEST_F(HatchingStyle, AResetStartsAsNew) {
  Hatching style(library_);
  Hatching other(library_);
  const auto first = drawn(style, 5);
  const hal::Image image = testPicture(kSize, 9);
  const auto wentOn = paint(style, next(image));
  style.reset();
  const auto anew = paint(style, next(image));
  EXPECT_NE(wentOn, anew) << "the past is to count";
  EXPECT_EQ(paint(other, next(image)), anew);
  style.reset();
  EXPECT_EQ(drawn(style, 5), first) << "lines that are born later know nothing of earlier ones";
}

TEST_F(HatchingStyle, EveryViewIsPaintedAtEverySize) {
  Hatching style(library_);
  std::vector<std::vector<std::uint8_t>> pictures{drawn(style, 1)};
  for (const DebugViewInfo& view : style.kind().views) {
    for (const hal::FrameSize size : {hal::FrameSize{1, 1}, {1, 9}, {9, 1}, {120, 90}}) {
      restart();
      const auto picture = paint(style, next(0.0, 0.0, size), view.name);
      for (std::size_t i = 3; i < picture.size(); i += 4) ASSERT_EQ(picture[i], 255) << view.name;
      if (size.width != 120) continue;
      EXPECT_THAT(pictures, testing::Not(testing::Contains(picture))) << view.name;
      pictures.push_back(picture);
    }
  }
}

TEST_F(HatchingStyle, AnotherQualityKeepsTheLines) {
  Hatching style(library_);
  drawn(style, 3);
  const auto before = drawnLines(style.set(0));
  scene::ArFrame frame = next(testPicture({96, 72}, 7), 0.0);
  frame.fullSize = kSize;
  paint(style, frame);
  const auto after = drawnLines(style.set(0));
  EXPECT_NEAR(static_cast<double>(after.size()), static_cast<double>(before.size()),
              0.15 * static_cast<double>(before.size()));
}

TEST_F(HatchingStyle, ABrushFileThatIsNotThereIsAnErrorAndChangesNothing) {
  Hatching style(library_);
  const config::ParameterValues values =
      style.parameters().with("brush_file", "/nonexistent/brush.png");
  EXPECT_FALSE(style.prepare(values));
  EXPECT_FALSE(style.kind().check(values));
  EXPECT_TRUE(style.prepare(style.parameters()));
}

TEST_F(HatchingStyle, FollowsTheSlopeOnThePaperAsTheImageTurns) {
  constexpr double kTurn = 0.4;
  const auto directionOf = [&](double turn) {
    Hatching style(library_);
    set(style, {{"lead", "0"}, {"wander", "0"}, {"directions", "1"}, {"slope", "30"}});
    restart();
    scene::ArFrame frame = next(flat(0.3));
    frame.canvasFromPicture.linear = {std::cos(turn), std::sin(turn)};
    style.paint(frame, {});
    const DrawnLine line = drawnLines(style.set(0)).at(5);
    const glm::vec2 along = line.points.back() - line.points.front();
    return std::fmod(std::atan2(along.y, along.x) + 2.0 * M_PI, M_PI);
  };
  // y points down
  EXPECT_NEAR(directionOf(0.0), M_PI - M_PI / 6.0, 0.01);
  EXPECT_NEAR(directionOf(kTurn), M_PI - M_PI / 6.0 - kTurn, 0.01);
}

}  // namespace
}  // namespace pleinair::styles
