#include "firmware_app/repair_station/command_cards.h"

#include <chrono>
#include <vector>

#include <gmock/gmock.h>

namespace pleinair::app {
namespace {

using namespace std::chrono_literals;
using procedure::StepCommandKind;

constexpr ShownTag kNext{.id = 570, .edgeShare = 0.2};
constexpr ShownTag kBack{.id = 571, .edgeShare = 0.2};
constexpr ShownTag kOther{.id = 3, .edgeShare = 0.2};

class CommandCardsTest : public testing::Test {
 protected:
  CommandCardsTest() { show({}, 2s); }
  /// Shows tags at 20 frames a second; the kinds of the commands that fire.
  std::vector<StepCommandKind> show(const std::vector<ShownTag>& tags, hal::Duration time) {
    std::vector<StepCommandKind> fired;
    for (const hal::TimePoint end = now_ + time; now_ < end; now_ += 50ms) {
      if (const auto command = cards_.see(tags, now_)) fired.push_back(command->kind);
    }
    return fired;
  }

  hal::TimePoint now_{100s};
  CommandCards cards_{{{570, {.kind = StepCommandKind::kNext, .operatorName = {}}},
                       {571, {.kind = StepCommandKind::kBack, .operatorName = {}}}}};
};

TEST_F(CommandCardsTest, ACardFiresOnceAfterASecond) {
  EXPECT_THAT(show({kOther, kNext}, 950ms), testing::IsEmpty());
  EXPECT_THAT(show({kOther, kNext}, 10s), testing::ElementsAre(StepCommandKind::kNext));
}

TEST_F(CommandCardsTest, ACardThatFlickersOrIsSeenTwiceDoesNotFireTwice) {
  show({kNext}, 500ms);
  show({}, 200ms);  // missed by the detector
  EXPECT_EQ(show({kNext}, 600ms).size(), 1U);
  show({}, 800ms);  // turned away for a moment
  EXPECT_THAT(show({kNext}, 5s), testing::IsEmpty());
  show({}, 1100ms);
  EXPECT_EQ(show({kNext}, 2s).size(), 1U) << "shown again on purpose";
}

TEST_F(CommandCardsTest, ACardThatPassesByFiresNothing) {
  for (int i = 0; i < 5; ++i) {
    EXPECT_THAT(show({kNext}, 600ms), testing::IsEmpty());
    show({}, 400ms);
  }
}

TEST_F(CommandCardsTest, OfTwoCardsAtOnceNoneFires) {
  EXPECT_THAT(show({kNext, kBack}, 5s), testing::IsEmpty());
  show({}, 350ms);
  EXPECT_THAT(show({kBack}, 2s), testing::ElementsAre(StepCommandKind::kBack));
}

TEST_F(CommandCardsTest, ASmallTagIsNoCardThatSomebodyShows) {
  EXPECT_THAT(show({{.id = 570, .edgeShare = 0.05}}, 5s), testing::IsEmpty());
}

TEST_F(CommandCardsTest, CardsInViewAtTheStartOrWhenTheCameraReturnsWait) {
  CommandCards fresh({{570, {.kind = StepCommandKind::kNext, .operatorName = {}}}});
  cards_ = fresh;
  EXPECT_THAT(show({kNext}, 5s), testing::IsEmpty());
  show({}, 1100ms);
  EXPECT_EQ(show({kNext}, 2s).size(), 1U);
  show({}, 2s);
  now_ += 5s;  // no camera
  EXPECT_THAT(show({kNext}, 5s), testing::IsEmpty());
  now_ -= 60s;  // its times go back
  EXPECT_THAT(show({kNext}, 5s), testing::IsEmpty());
}

}  // namespace
}  // namespace pleinair::app
