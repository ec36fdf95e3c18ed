// A display that shows pictures for months: 10,000 flips take no memory.
#include <gtest/gtest.h>

#include "tests/support/allocation_count.h"
#include "tests/unit/hal/outputs/display/display_test.h"

namespace pleinair::hal {
namespace {

class DisplayAllocations : public support::DisplayTest {
 protected:
  void showPictures(int count) {
    for (int i = 0; i < count; ++i) {
      ASSERT_TRUE(showAndWait().has_value());
      events_.clear();
    }
  }
};

TEST_F(DisplayAllocations, TenThousandFlipsAllocateNothing) {
  constexpr int kFlips = 10'000;
  plug();
  cards_.shown.reserve(kFlips + 100);
  cards_.changesOfFlips.reserve(kFlips + 100);
  ASSERT_TRUE(start().has_value());
  showPictures(50);
  const int before = cards_.flips;
  EXPECT_EQ(support::allocationsIn([&] { showPictures(kFlips); }), 0) << support::allocationSites();
  EXPECT_EQ(cards_.flips - before, kFlips);
  EXPECT_EQ(cards_.modesets, 1);
  // The control: a mode that is set makes buffers.
  output_.reset();
  EXPECT_GT(support::allocationsIn([&] { ASSERT_TRUE(start().has_value()); }), 0);
}

}  // namespace
}  // namespace pleinair::hal
