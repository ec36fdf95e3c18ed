#include "firmware_app/repair_station/live_overlay.h"

#include <algorithm>
#include <filesystem>

#include <gtest/gtest.h>

#include "pipeline/procedure/procedure_file.h"
#include "tests/support/av_movie.h"
#include "tests/support/awaited.h"
#include "tests/support/temporary_folder.h"

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
  using Content = std::shared_ptr<const overlay::OverlayContent>;

  /// Waits for what is being made.
  Content made(const StepShown& shown) {
    return support::awaited("an overlay", [&] { return overlay_.update(shown, now_); });
  }
  /// Waits for all of a new step.
  Content madeWhole(const StepShown& shown) {
    return support::awaited("an inset", [&] {
      Content content = made(shown);
      return isBlank(content->inset) ? nullptr : content;
    });
  }

  static bool isBlank(const hal::Image& image) {
    for (int y = 0; y < image.size().height; ++y) {
      const auto row = image.view().row(0, y);
      if (std::ranges::any_of(row, [](std::uint8_t each) { return each != 0; })) return false;
    }
    return true;
  }

  static bool isSame(const hal::Image& a, const hal::Image& b) {
    if (a.size() != b.size()) return false;
    for (int y = 0; y < a.size().height; ++y) {
      if (!std::ranges::equal(a.view().row(0, y), b.view().row(0, y))) return false;
    }
    return true;
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
  const auto second = madeWhole(step(1));
  EXPECT_NE(second->looks, first->looks);
  EXPECT_EQ(overlay_.update(step(1), now_), nullptr);
}

TEST_F(LiveOverlayTest, TheInstructionDoesNotWaitForTheInset) {
  const Content first = overlay_.update(step(0), now_);
  ASSERT_NE(first, nullptr);
  EXPECT_FALSE(isBlank(first->inset));
  const Content second = made(step(1));
  EXPECT_FALSE(isSame(second->panel, first->panel));
  EXPECT_NE(second->looks, first->looks);
  EXPECT_TRUE(isBlank(second->inset)) << "it takes many times as long";
  EXPECT_EQ(second->inset.size(), first->inset.size()) << "its place stays clear of labels";
  const Content whole = made(step(1));
  EXPECT_FALSE(isBlank(whole->inset));
  EXPECT_TRUE(isSame(whole->panel, second->panel));
  EXPECT_EQ(whole->looks, second->looks);
}

TEST_F(LiveOverlayTest, AMovieComesAfterTheInstructionAndStaysWhileTextsChange) {
  const support::TemporaryFolder folder;
  support::writeAvMovie(folder.path() / "turn.mkv", {.size = {64, 36}, .frames = 50});
  auto moving = std::make_shared<procedure::Procedure>(*procedure_);
  moving->steps[1].movie = procedure::StepMovie{.file = "turn.mkv", .size = {64, 36}};
  procedure_ = moving;
  LiveOverlay overlay(moving->model.get(), folder.path(), {320, 240}, false, {});
  ASSERT_EQ(overlay.update(step(0), now_)->movie, nullptr);
  const auto next = [&](const StepShown& shown) {
    return support::awaited("an overlay", [&] { return overlay.update(shown, now_); });
  };
  const Content first = next(step(1));
  EXPECT_EQ(first->movie, nullptr) << "it takes longer";
  EXPECT_GT(first->moviePlace.size.width, 0) << "its place stays clear of text";
  // Inset and movie come in either order; one that is still late would come before the notice.
  const auto withMovie = support::awaited("the movie and the inset", [&] {
    Content content = next(step(1));
    return content->movie && !isBlank(content->inset) ? content : nullptr;
  });
  EXPECT_EQ(withMovie->movie->frames.front().image.size(), withMovie->moviePlace.size);
  overlay.notify("two inputs at once", now_);
  EXPECT_EQ(next(step(1))->movie, withMovie->movie) << "it is not decoded again";
  EXPECT_EQ(next(step(2))->movie, nullptr);
}

TEST_F(LiveOverlayTest, OfStepsThatChangeFasterTheLastOnesMovieIsShown) {
  const support::TemporaryFolder folder;
  support::writeAvMovie(folder.path() / "turn.mkv", {.size = {64, 36}, .frames = 300});
  auto moving = std::make_shared<procedure::Procedure>(*procedure_);
  for (auto& each : moving->steps) {
    each.movie = procedure::StepMovie{.file = "turn.mkv", .size = {64, 36}};
  }
  procedure_ = moving;
  LiveOverlay overlay(moving->model.get(), folder.path(), {320, 240}, false, {});
  ASSERT_NE(overlay.update(step(0), now_), nullptr);
  for (const std::size_t each : {1U, 0U, 1U, 0U}) {
    support::awaited("an overlay", [&] { return overlay.update(step(each), now_); });
  }
  support::awaited("the movie", [&] {
    const Content content = overlay.update(step(0), now_);
    return content && content->movie;
  });
}

TEST_F(LiveOverlayTest, OfStepsThatChangeFasterTheNewestIsShownInTheEnd) {
  ASSERT_NE(overlay_.update(step(0), now_), nullptr);
  for (std::size_t i = 1; i < 5; ++i) overlay_.update(step(i), now_);
  const auto expected =
      LiveOverlay(procedure_->model.get(), kGearbox, {320, 240}, false, {}).update(step(4), now_);
  const Content last = support::awaited("the newest step", [&] {
    Content content = madeWhole(step(4));
    return content->looks == expected->looks ? content : nullptr;
  });
  EXPECT_TRUE(isSame(last->inset, expected->inset));
  EXPECT_EQ(overlay_.update(step(4), now_), nullptr);
}

TEST_F(LiveOverlayTest, AnotherTextKeepsTheInset) {
  const auto loaded = procedure_;  // its model is the overlay's machine
  const auto changing = std::make_shared<procedure::Procedure>(*loaded);
  procedure_ = changing;
  const auto first = overlay_.update(step(0), now_);
  ASSERT_NE(first, nullptr);
  // From here on, an inset that is drawn anew shows another machine.
  auto flat = std::make_shared<scene::Model>(*loaded->model);
  for (scene::ModelPart& each : flat->parts) {
    glm::dmat4 flattened(1.0);
    flattened[2][2] = 0.3;
    each.modelFromPart = flattened * each.modelFromPart;
  }
  changing->model = flat;
  overlay_.notify("two inputs at once", now_);
  EXPECT_TRUE(isSame(made(step(0))->inset, first->inset));
  EXPECT_TRUE(isSame(made(step(0, "Gap: 1_"))->inset, first->inset));
  const auto anew = LiveOverlay(flat.get(), kGearbox, {320, 240}, false, {}).update(step(0), now_);
  EXPECT_FALSE(isSame(anew->inset, first->inset));
  now_ += std::chrono::seconds(6);
  EXPECT_NE(made(step(0, "Gap: 1_")), nullptr) << "the notice is gone";
}

TEST_F(LiveOverlayTest, ALaterNoticeHidesNoFailure) {
  LiveOverlay overlay(procedure_->model.get(), kGearbox, {1280, 720}, false, {});
  const auto heightOf = [&] {
    return support::awaited("an overlay",
                            [&] { return overlay.update(step(procedure::kEnd), now_); })
        ->panel.size()
        .height;
  };
  const int plain = heightOf();
  overlay.notifyFailure("the disk is full", now_);
  const int failed = heightOf();
  EXPECT_GT(failed, plain);
  overlay.notify("two inputs at once", now_);
  const int both = heightOf();
  EXPECT_GT(both, failed);
  overlay.notify("one moment", now_ + std::chrono::seconds(4));
  EXPECT_EQ(heightOf(), both) << "in place of the notice, not of the failure";
  now_ += std::chrono::seconds(6);
  EXPECT_EQ(heightOf(), failed) << "the failure had its time";
}

}  // namespace
}  // namespace pleinair::app
