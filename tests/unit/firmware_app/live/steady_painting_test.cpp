#include "firmware_app/live/status/steady_painting.h"

#include <filesystem>
#include <utility>

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

namespace pleinair::app {
namespace {

using namespace std::chrono_literals;

class SteadyPaintingTest : public testing::Test {
 protected:
  /// Shows a painting each 100 ms on these outputs.
  void paint(hal::Duration time) {
    for (const hal::TimePoint end = now_ + time; now_ < end;) {
      for (OutputProgress& each : outputs_) {
        if (each.isExcused) continue;
        ++each.paintings;
        ++each.shown;
      }
      pass(100ms);
    }
  }
  /// Shows waiting pictures only.
  void wait(hal::Duration time) {
    for (const hal::TimePoint end = now_ + time; now_ < end;) {
      for (OutputProgress& each : outputs_) ++each.shown;
      pass(100ms);
    }
  }
  void pass(hal::Duration time) {
    now_ += time;
    steady_.update(outputs_, now_);
  }

  std::vector<OutputProgress> outputs_{{.name = "display", .isScreen = true}};
  SteadyPainting steady_;
  hal::TimePoint now_{100s};
};

TEST_F(SteadyPaintingTest, LastsForAMinuteOfPaintings) {
  paint(60s);
  EXPECT_FALSE(steady_.hasLasted()) << "the first one was shown 100 ms after the start";
  paint(200ms);
  EXPECT_TRUE(steady_.hasLasted());
}

TEST_F(SteadyPaintingTest, NeedsNoReaderOfALoopback) {
  outputs_.push_back({.name = "loopback"});
  const auto pass = [this](hal::Duration time, int displayed) {
    for (const hal::TimePoint end = now_ + time; now_ < end;) {
      outputs_[0].paintings += static_cast<unsigned>(displayed);
      ++outputs_[1].skipped;
      this->pass(100ms);
    }
  };
  pass(61s, 0);
  EXPECT_FALSE(steady_.hasLasted()) << "nobody has seen any";
  pass(61s, 1);
  EXPECT_TRUE(steady_.hasLasted());
}

TEST_F(SteadyPaintingTest, IsNotWaiting) {
  wait(10min);
  EXPECT_FALSE(steady_.hasLasted());
  paint(1s);
  EXPECT_FALSE(steady_.hasLasted()) << "time without paintings does not count";
}

TEST_F(SteadyPaintingTest, IsNotTheSamePaintingForAMinute) {
  paint(1s);
  pass(59s);
  pass(59s);
  EXPECT_FALSE(steady_.hasLasted());
}

TEST_F(SteadyPaintingTest, SurvivesShortPauses) {
  paint(30s);
  wait(9s);
  paint(22s);
  EXPECT_TRUE(steady_.hasLasted());
}

TEST_F(SteadyPaintingTest, BeginsAnewAfterALongPause) {
  paint(50s);
  wait(11s);
  paint(50s);
  EXPECT_FALSE(steady_.hasLasted());
  paint(11s);
  EXPECT_TRUE(steady_.hasLasted());
}

TEST_F(SteadyPaintingTest, IsThatOfAllScreensThatCanShowSomething) {
  outputs_.push_back({.name = "second", .isExcused = true, .isScreen = true});
  paint(61s);
  EXPECT_TRUE(steady_.hasLasted());
  outputs_.back().isExcused = false;
  SteadyPainting both;
  for (int i = 0; i < 700; ++i) {
    ++outputs_.front().paintings;
    now_ += 100ms;
    both.update(outputs_, now_);
  }
  EXPECT_FALSE(both.hasLasted()) << "the second one hangs";
}

TEST_F(SteadyPaintingTest, NeedsAScreen) {
  outputs_.front().isExcused = true;
  paint(2min);
  EXPECT_FALSE(steady_.hasLasted());
  outputs_.clear();
  paint(2min);
  EXPECT_FALSE(steady_.hasLasted());
}

TEST_F(SteadyPaintingTest, StaysOnceItHasLasted) {
  paint(61s);
  wait(10min);
  EXPECT_TRUE(steady_.hasLasted());
}

TEST(SteadyMarkTest, IsAFileThatComesOnce) {
  const support::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "steady";
  SteadyMark mark(file);
  std::vector<OutputProgress> outputs{{.name = "display", .isScreen = true}};
  hal::TimePoint now{100s};
  const auto paint = [&](int seconds) {
    for (int i = 0; i < seconds; ++i) {
      ++outputs.front().paintings;
      mark.update(outputs, now += 1s);
    }
  };
  paint(60);
  EXPECT_FALSE(std::filesystem::exists(file));
  paint(1);
  EXPECT_TRUE(std::filesystem::exists(file));
  std::filesystem::remove(file);
  paint(100);
  EXPECT_FALSE(std::filesystem::exists(file)) << "once";
}

}  // namespace
}  // namespace pleinair::app
