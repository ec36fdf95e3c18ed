#include "pipeline/gpu/images/per_size.h"

#include <gtest/gtest.h>

namespace pleinair::gpu {
namespace {

struct Made {
  explicit Made(int number) : from(number) {}
  int from = 0;
};

TEST(PerSize, MakesOneOfEachSizeAndKeepsIt) {
  PerSize<Made> all;
  Made& small = all.of({4, 3}, 1);
  Made& large = all.of({8, 6}, 2);
  EXPECT_EQ(small.from, 1);
  EXPECT_EQ(large.from, 2);
  EXPECT_EQ(&all.of({4, 3}, 3), &small);
  EXPECT_EQ(small.from, 1);
  all.clear();
  EXPECT_EQ(all.of({4, 3}, 4).from, 4);
}

}  // namespace
}  // namespace pleinair::gpu
