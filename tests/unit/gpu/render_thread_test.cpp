#include "pipeline/gpu/render_thread.h"

#include <array>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pthread.h>

namespace pleinair::gpu {
namespace {

TEST(RenderThread, RunsTasksInOrderOnOneThreadOfItsName) {
  RenderThread thread("painter");
  std::vector<int> order;
  std::vector<std::thread::id> threads;
  std::array<char, 16> name{};
  for (int i = 0; i < 100; ++i) {
    thread.run([&, i] {
      order.push_back(i);
      threads.push_back(std::this_thread::get_id());
      pthread_getname_np(pthread_self(), name.data(), name.size());
    });
    EXPECT_EQ(order.size(), static_cast<std::size_t>(i + 1));  // done on return
  }
  EXPECT_TRUE(std::ranges::is_sorted(order));
  EXPECT_THAT(threads, testing::Each(threads.front()));
  EXPECT_NE(threads.front(), std::this_thread::get_id());
  EXPECT_STREQ(name.data(), "painter");
}

TEST(RenderThread, LetsExceptionsOutAndGoesOn) {
  RenderThread thread("painter");
  try {
    thread.run([] { throw std::runtime_error("no paint"); });
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "no paint");
  }
  bool ran = false;
  thread.run([&] { ran = true; });
  EXPECT_TRUE(ran);
}

TEST(RenderThread, EndsUnused) {
  const RenderThread thread("painter");
}

TEST(RenderThreadDeathTest, RefusesLongNamesAndToWaitForItself) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_DEATH(RenderThread("a name of 16 char"), "failed == 0");
  EXPECT_DEATH(
      {
        RenderThread thread("painter");
        thread.run([&] { thread.run([] {}); });
      },
      "get_id");
}

}  // namespace
}  // namespace pleinair::gpu
