// Outputs that the painter cannot paint for, under a stepped clock.
#include <chrono>
#include <memory>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/runtime/live_pipeline.h"
#include "tests/support/live_simulation.h"

namespace pleinair::runtime {
namespace {

using namespace std::chrono_literals;

class RefusedOutputTest : public testing::Test {
 protected:
  RefusedOutputTest()
      : selector_(support::selectorOf(
            [](hal::Clock& clock) {
              return std::make_unique<support::PacedCamera>(support::PacedCameraOptions{}, clock);
            },
            live_.clock)) {}
  void begin() {
    live_.begin(selector_);
    live_.start();
  }
  RuntimeStatus status() const { return live_.chain->status(); }
  void expectSumsToAgree() const {
    EXPECT_TRUE(live_.chain->ledger().counts().addsUp());
    for (const auto& output : status().outputs) EXPECT_TRUE(output.addsUp()) << output.name;
  }

  support::LiveSimulation live_;
  hal::CameraSelector selector_;
};

TEST_F(RefusedOutputTest, PaintsOnBesideAnOutputThatItCannotPaintFor) {
  begin();
  live_.gpu.widest = 16;
  std::vector<support::CapturingOutput::Note> wideNotes;
  OutputStageOptions options{.name = "wide", .waiting = 16};
  options.request = {.size = {32, 6}};
  options.reopen = [&]() -> hal::Result<std::unique_ptr<hal::Output>> {
    return std::make_unique<support::CapturingOutput>(wideNotes, live_.clock);
  };
  auto output = *options.reopen();
  const auto format = *output->start(options.request);
  OutputStage& wide = live_.chain->addOutput(std::move(output), format, std::move(options));
  live_.runFor(20s);
  EXPECT_EQ(status().painting.contextLosses, 0U);
  EXPECT_GT(live_.notes.size(), 580U);
  EXPECT_TRUE(wideNotes.empty());
  ASSERT_TRUE(wide.status().isFailed);
  EXPECT_EQ(wide.status().failure->problem, "does not paint so wide");
  EXPECT_EQ(wide.status().failures, 7U) << "it is tried again, ever more rarely";

  live_.chain->paint().renew();
  live_.runFor(1s);
  EXPECT_TRUE(status().painting.hasPainter) << "also another painter";
  wide.reconfigure({.size = {16, 6}});
  live_.runFor(10s);
  EXPECT_FALSE(wide.status().isFailed);
  EXPECT_GT(wideNotes.size(), 100U);
  EXPECT_GT(live_.notes.size(), 900U);
  expectSumsToAgree();
}

TEST_F(RefusedOutputTest, GivesNoFilmUpThatItCannotPaintForJustNow) {
  begin();
  live_.runFor(1s);
  std::vector<support::CapturingOutput::Note> filmNotes;
  OutputStage& film = live_.addOutput(
      std::make_unique<support::CapturingOutput>(filmNotes, live_.clock), {.name = "film"});
  live_.runFor(1s);
  live_.gpu.widest = 4;
  live_.chain->paint().renew();
  live_.runFor(1s);
  live_.gpu.widest = 16;
  const std::size_t before = filmNotes.size();
  live_.runFor(10s);
  EXPECT_FALSE(film.status().isFailed);
  EXPECT_GT(filmNotes.size(), before + 100U);
  expectSumsToAgree();
}

TEST_F(RefusedOutputTest, HasNoPainterWhereItCanPaintForNoOutput) {
  begin();
  live_.runFor(1s);
  live_.gpu.widest = 16;
  live_.chain->output(0).reconfigure({.size = {32, 6}});
  live_.runFor(2s);
  EXPECT_FALSE(status().painting.hasPainter);
  EXPECT_EQ(status().painting.failure->problem, "does not paint so wide");
  live_.chain->output(0).reconfigure({.size = {16, 6}});
  live_.runFor(10s);
  EXPECT_TRUE(status().painting.hasPainter);
  EXPECT_EQ(live_.gpu.painters, 1);
  expectSumsToAgree();
  live_.chain->paint().stop();
  live_.gpu.widest = 4;
  EXPECT_THROW(live_.chain->paint().start(), hal::Failure);
  EXPECT_EQ(live_.gpu.painters, 0);
}

}  // namespace
}  // namespace pleinair::runtime
