// Work in a process of its own, which may crash. This executable's main() is that process, too.
#include "pipeline/gpu/frames/trial_process.h"

#include <array>
#include <csignal>
#include <cstdlib>
#include <string_view>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace pleinair::gpu {
namespace {

using testing::HasSubstr;

hal::Result<int> resultOf(TrialProcess& process) {
  const hal::SteadyClock clock;
  const hal::TimePoint end = clock.now() + std::chrono::seconds(30);
  for (;;) {
    if (const auto result = process.poll()) return *result;
    if (clock.now() > end) return tl::unexpected(hal::Error{.problem = "never ended"});
    std::this_thread::yield();
  }
}

TEST(TrialProcesses, GiveTheirExitStatus) {
  TrialProcess process({"test", "--as-trial", "three"}, {}, "do its work", hal::steadyClock());
  const hal::Result<int> result = resultOf(process);
  ASSERT_TRUE(result) << result.error().message();
  EXPECT_EQ(*result, 3);
  EXPECT_EQ(*resultOf(process), 3) << "and go on doing so";
}

TEST(TrialProcesses, ThatCrashAreAReasonAndNoCrashOfOurs) {
  TrialProcess process({"test", "--as-trial", "crash"}, {}, "do its work", hal::steadyClock());
  const hal::Result<int> result = resultOf(process);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().kind, hal::ErrorKind::kUnsupported);
  EXPECT_THAT(result.error().problem, HasSubstr("crashes where it has to do its work (signal 11)"));
}

TEST(TrialProcesses, ThatHangAreGivenUp) {
  hal::SteppedClock clock;
  {
    TrialProcess process({"test", "--as-trial", "hang"}, {}, "do its work", clock);
    EXPECT_FALSE(process.poll());
    clock.advance(std::chrono::seconds(61));
    const auto result = process.poll();
    ASSERT_TRUE(result);
    EXPECT_THAT(result->error().problem, HasSubstr("takes too long to do its work"));
  }
  SUCCEED() << "and ended: the destructor has waited for it";
}

TEST(TrialProcesses, HaveTheDescriptorsInTheirOrder) {
  std::array<int, 2> first{};
  std::array<int, 2> second{};
  ASSERT_EQ(pipe(first.data()), 0);
  ASSERT_EQ(pipe(second.data()), 0);
  const std::array<int, 2> given{second[1], first[1]};
  TrialProcess process({"test", "--as-trial", "write"}, given, "do its work", hal::steadyClock());
  EXPECT_EQ(*resultOf(process), 0);
  char got = 0;
  EXPECT_EQ(read(second[0], &got, 1), 1);
  EXPECT_EQ(got, 'a');
  EXPECT_EQ(read(first[0], &got, 1), 1);
  EXPECT_EQ(got, 'b');
  for (const int fd : {first[0], first[1], second[0], second[1]}) close(fd);
}

/// What this executable does as a trial.
int asTrial(std::string_view what) {
  if (what == "three") return 3;
  if (what == "crash") {
    std::signal(SIGSEGV, SIG_DFL);
    std::raise(SIGSEGV);
  }
  if (what == "hang") {
    for (;;) pause();
  }
  if (what == "write") {
    return write(TrialProcess::kFirstDescriptor, "a", 1) == 1 &&
                   write(TrialProcess::kFirstDescriptor + 1, "b", 1) == 1
               ? 0
               : 1;
  }
  return 9;
}

}  // namespace
}  // namespace pleinair::gpu

int main(int argc, char** argv) {
  if (argc == 3 && std::string_view(argv[1]) == "--as-trial") {
    return pleinair::gpu::asTrial(argv[2]);
  }
  testing::InitGoogleMock(&argc, argv);
  return RUN_ALL_TESTS();
}
