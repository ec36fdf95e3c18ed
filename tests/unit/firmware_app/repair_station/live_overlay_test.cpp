#include "firmware_app/repair_station/live_overlay.h"

#include <filesystem>
#include <thread>

#include <gtest/gtest.h>

#include "pipeline/procedure/procedure_file.h"

namespace pleinair::app {
namespace {

const std::filesystem::path kGearbox =
    std::filesystem::path(PLEINAIR_TESTS_DIR).parent_path() / "config/procedures/gearbox";

class LiveOverlayTest : public testing::Test {
 protected:
  StepShown step(std::size_t index, const std::string& request = "Page Down: done") const {
    return {.procedure = procedure_,
            .step = index,
            .partsOff = {},
            .language = "en",
            .request = request,
            .notice = {}};
  }
  /// Waits for what is being made.
  std::shared_ptr<const overlay::OverlayContent> made(const StepShown& shown) {
    for (;;) {
      if (auto content = overlay_.update(shown, now_)) return content;
      std::this_thread::yield();
    }
  }

  std::shared_ptr<const procedure::Procedure> procedure_ =
      std::make_shared<const procedure::Procedure>(procedure::loadProcedure(kGearbox));
  hal::TimePoint now_{std::chrono::seconds(10)};
  LiveOverlay overlay_{procedure_->model.get(), kGearbox, {320, 240}, false, {570, 571}};
};

TEST_F(LiveOverlayTest, TheFirstIsThereAtOnceAndOthersOnceTheyAreMade) {
  const auto first = overlay_.update(step(0), now_);
  ASSERT_NE(first, nullptr);
  EXPECT_EQ(first->cards, (std::vector<int>{570, 571}));
  EXPECT_EQ(overlay_.update(step(0), now_), nullptr) << "the same";
  const auto second = made(step(1));
  EXPECT_NE(second->looks, first->looks);
  EXPECT_EQ(overlay_.update(step(1), now_), nullptr);
}

TEST_F(LiveOverlayTest, OfStepsThatChangeFasterTheNewestIsShownInTheEnd) {
  ASSERT_NE(overlay_.update(step(0), now_), nullptr);
  for (std::size_t i = 1; i < 5; ++i) overlay_.update(step(i), now_);
  std::shared_ptr<const overlay::OverlayContent> last;
  const auto expected =
      LiveOverlay(procedure_->model.get(), kGearbox, {320, 240}, false, {}).update(step(4), now_);
  do {
    last = made(step(4));
  } while (last->looks != expected->looks);
  EXPECT_EQ(overlay_.update(step(4), now_), nullptr);
}

TEST_F(LiveOverlayTest, AnotherTextKeepsTheInset) {
  ASSERT_NE(overlay_.update(step(0), now_), nullptr);
  overlay_.notify("the disk is full", now_);
  const auto noted = made(step(0));
  const auto typed = made(step(0, "Gap: 1_"));
  EXPECT_EQ(noted->inset.size(), typed->inset.size());
  now_ += std::chrono::seconds(6);
  EXPECT_NE(made(step(0, "Gap: 1_")), nullptr) << "the notice is gone";
}

}  // namespace
}  // namespace pleinair::app
