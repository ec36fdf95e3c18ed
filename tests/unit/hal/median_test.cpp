#include "hal/median.h"

#include <array>
#include <span>
#include <vector>

#include <gtest/gtest.h>

namespace pleinair::hal {
namespace {

TEST(MedianOf, IsTheMiddleOne) {
  EXPECT_EQ(medianOf(std::vector{7}), 7);
  EXPECT_EQ(medianOf(std::vector{9, 1, 5}), 5);
}

TEST(MedianOf, OfAnEvenNumberIsTheUpperOfTwo) {
  std::array<double, 4> values{4.0, 1.0, 3.0, 2.0};
  EXPECT_EQ(medianOf(values), 3.0);
}

TEST(MedianOf, LooksAtAPart) {
  std::array<int, 5> values{5, 4, 6, 100, 100};
  EXPECT_EQ(medianOf(std::span(values).first(3)), 5);
}

}  // namespace
}  // namespace pleinair::hal
