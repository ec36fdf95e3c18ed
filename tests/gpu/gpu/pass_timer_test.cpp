#include "pipeline/gpu/programs/pass_timer.h"

#include <gtest/gtest.h>

#include "pipeline/gpu/images/resampler.h"
#include "tests/support/gl_test.h"

namespace pleinair::gpu {
namespace {

class PassTimerTest : public support::GlTest {};

TEST_F(PassTimerTest, CountsAndAddsUpPassesUnderTheirNamesWithFences) {
  PassTimer timer(PassTiming::kFences);
  Resampler resampler{ShaderLibrary{}};
  const Texture picture(TextureFormat::kRgba8, {64, 64}, TextureFilter::kLinear);
  for (int i = 0; i < 3; ++i) {
    {
      const auto scope = timer.measure("shrink");
      resampler.resample(picture, {32, 32});
    }
    if (i == 0) const auto scope = timer.measure("nothing");
  }
  ASSERT_EQ(timer.times().size(), 2U);
  EXPECT_EQ(timer.times()[0].pass, "shrink");
  EXPECT_EQ(timer.times()[0].count, 3);
  EXPECT_GT(timer.times()[0].last.count(), 0);
  EXPECT_GT(timer.times()[0].total, timer.times()[0].last);
  EXPECT_EQ(timer.times()[1].pass, "nothing");
  EXPECT_EQ(timer.times()[1].count, 1);
}

TEST_F(PassTimerTest, KeepsSilentWhenOffOrWhereQueriesLie) {
  PassTimer off;
  { const auto scope = off.measure("a"); }
  EXPECT_TRUE(off.times().empty());
  ContextInfo software = context_->info();
  software.isSoftware = true;
  PassTimer queries(PassTiming::kQueries, &software);
  { const auto scope = queries.measure("a"); }
  EXPECT_TRUE(queries.times().empty());
}

TEST_F(PassTimerTest, ReadsQueriesLaterWithoutWaiting) {
  ContextInfo info = context_->info();
  if (!info.hasTimerQuery) GTEST_SKIP() << "the driver has no GL_EXT_disjoint_timer_query";
  info.isSoftware = false;  // the numbers would lie, the bookkeeping does not
  PassTimer timer(PassTiming::kQueries, &info);
  for (int i = 0; i < 10; ++i) {
    { const auto scope = timer.measure("nothing"); }
    EXPECT_TRUE(Fence::insert().wait());
  }
  ASSERT_EQ(timer.times().size(), 1U);
  EXPECT_GE(timer.times()[0].count, 1);
  EXPECT_LT(timer.times()[0].count, 10);  // the last is still in flight
}

TEST_F(PassTimerTest, AddsUpTheRunsOfAFrame) {
  PassTimer timer(PassTiming::kFences);
  for (const int runs : {3, 1}) {
    timer.beginFrame();
    for (int i = 0; i < runs; ++i) const auto scope = timer.measure("nothing");
  }
  const PassTime& time = timer.times()[0];
  EXPECT_EQ(time.count, 4);
  EXPECT_EQ(time.frames, 2);
  EXPECT_EQ(time.mean(), time.total / 2);
  EXPECT_GE(time.peak, time.last);
  EXPECT_GE(time.peak, time.total - time.peak);
}

TEST_F(PassTimerTest, SamplesOneFrameInManyAlsoWithoutQueries) {
  ContextInfo info = context_->info();
  info.hasTimerQuery = false;
  PassTimer timer(PassTiming::kSampled, &info);
  EXPECT_FALSE(timer.hasQueries());
  const auto frame = [&] {
    timer.beginFrame();
    const auto scope = timer.measure("nothing");
  };
  for (std::uint64_t i = 1; i < PassTimer::kSampledEvery; ++i) frame();
  EXPECT_TRUE(timer.times().empty());
  for (std::uint64_t i = 0; i < 2 * PassTimer::kSampledEvery; ++i) frame();
  ASSERT_EQ(timer.times().size(), 1U);
  EXPECT_EQ(timer.times()[0].frames, 2);
}

using PassTimerDeathTest = PassTimerTest;

TEST_F(PassTimerDeathTest, RefusesPassesWithinPasses) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  PassTimer timer(PassTiming::kFences);
  const auto outer = timer.measure("outer");
  EXPECT_DEATH(timer.measure("inner"), "isMeasuring_");
}

}  // namespace
}  // namespace pleinair::gpu
