#include "pipeline/overlay/other_machine.h"

#include <numeric>
#include <vector>

#include <gtest/gtest.h>

namespace pleinair::overlay {
namespace {

using namespace std::chrono_literals;

class OtherMachineTest : public testing::Test {
 protected:
  bool sees(std::vector<int> unknown, bool isSeen, hal::Duration later = 33ms) {
    now_ += later;
    return other_.update(unknown, isSeen, now_);
  }

  OtherMachine other_;
  hal::TimePoint now_;
};

TEST_F(OtherMachineTest, ATagThatWasNeverBesideTheMachineIsAnotherOnes) {
  EXPECT_FALSE(sees({}, true));
  EXPECT_TRUE(sees({7}, false)) << "instead of the machine's";
  EXPECT_FALSE(sees({}, false));
}

TEST_F(OtherMachineTest, ATagBesideTheMachineStaysItsNeighbourWhenAHandCoversTheMachines) {
  EXPECT_FALSE(sees({7}, true));
  EXPECT_FALSE(sees({7}, false));
  EXPECT_TRUE(sees({7, 8}, false)) << "8 is new";
}

TEST_F(OtherMachineTest, ANeighbourIsForgotten) {
  EXPECT_FALSE(sees({7}, true));
  EXPECT_FALSE(sees({7}, false, OtherMachine::kNeighbourFor));
  EXPECT_TRUE(sees({7}, false));
  EXPECT_FALSE(sees({7}, true));
  other_.reset();
  EXPECT_TRUE(sees({7}, false)) << "after a cut";
}

TEST_F(OtherMachineTest, OfTooManyTheLatestAreKept) {
  std::vector<int> ids(OtherMachine::kMostNeighbours + 10);
  std::iota(ids.begin(), ids.end(), 100);
  EXPECT_FALSE(sees({7}, true));
  EXPECT_FALSE(sees(ids, true));
  EXPECT_TRUE(sees({7}, false));
  EXPECT_FALSE(sees({ids.back()}, false));
}

}  // namespace
}  // namespace pleinair::overlay
