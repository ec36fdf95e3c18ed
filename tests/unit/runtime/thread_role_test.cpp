#include "pipeline/runtime/thread_role.h"

#include <chrono>
#include <cstdlib>

#include <gtest/gtest.h>
#include <sched.h>
#include <sys/resource.h>

namespace pleinair::runtime {
namespace {

constexpr rlim_t kSoftMicroseconds = 50'000;
constexpr rlim_t kHardMicroseconds = 5'000'000;

/// A prompt thread that computes for ten times its limit, as a child of the test.
[[noreturn]] void computeWithoutAPause() {
  const rlimit limit{.rlim_cur = kSoftMicroseconds, .rlim_max = kHardMicroseconds};
  setrlimit(RLIMIT_RTTIME, &limit);
  if (!setThreadRole("prompt", ThreadRole::kPrompt)) std::_Exit(2);
  if (sched_getscheduler(0) != SCHED_RR || takeDemotion()) std::_Exit(3);
  const auto end =
      std::chrono::steady_clock::now() + std::chrono::microseconds(10 * kSoftMicroseconds);
  while (std::chrono::steady_clock::now() < end) {
  }
  const bool isOrdinary = sched_getscheduler(0) == SCHED_OTHER;
  std::_Exit(isOrdinary && takeDemotion() && !takeDemotion() ? 0 : 4);
}

TEST(ThreadRoleDeathTest, APromptThreadThatComputesTooLongGoesOnAsAnOrdinaryOne) {
  const sched_param parameters{.sched_priority = kPromptPriority};
  if (sched_setscheduler(0, SCHED_RR, &parameters) != 0) {
    GTEST_SKIP() << "real-time priority is not permitted here";
  }
  const sched_param none{};
  ASSERT_EQ(sched_setscheduler(0, SCHED_OTHER, &none), 0);
  EXPECT_EXIT(computeWithoutAPause(), testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace pleinair::runtime
