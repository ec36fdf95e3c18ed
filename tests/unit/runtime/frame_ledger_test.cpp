#include "pipeline/runtime/frame_ledger.h"

#include <chrono>
#include <set>

#include <gtest/gtest.h>

namespace pleinair::runtime {
namespace {

using namespace std::chrono_literals;

TEST(FrameLedger, EndsEachFrameUnderOneName) {
  FrameLedger ledger;
  const auto first = ledger.open();
  const auto second = ledger.open();
  ledger.count(Fate::kCorrupt, 3);
  EXPECT_EQ(ledger.counts().underWay, 2u);
  ledger.settle(first, Fate::kShown);
  ledger.settle(second, Fate::kReplaced);
  const LedgerCounts counts = ledger.counts();
  EXPECT_EQ(counts.captured, 5u);
  EXPECT_EQ(counts.underWay, 0u);
  EXPECT_EQ(counts.of(Fate::kShown), 1u);
  EXPECT_EQ(counts.of(Fate::kReplaced), 1u);
  EXPECT_EQ(counts.of(Fate::kCorrupt), 3u);
  EXPECT_EQ(counts.dropped(), 4u);
  EXPECT_TRUE(counts.addsUp());
}

TEST(FrameLedger, GivesAFrameOfSeveralOutputsItsBestFate) {
  FrameLedger ledger;
  const auto ticket = ledger.open();
  ledger.split(ticket, 3);
  ledger.settle(ticket, Fate::kOutputBusy);
  ledger.settle(ticket, Fate::kShown);
  EXPECT_EQ(ledger.counts().underWay, 1u);
  ledger.settle(ticket, Fate::kLate);
  EXPECT_EQ(ledger.counts().of(Fate::kShown), 1u);
  EXPECT_EQ(ledger.counts().dropped(), 0u);
  EXPECT_TRUE(ledger.counts().addsUp());
}

TEST(FrameLedger, UsesItsSlotsAgain) {
  FrameLedger ledger;
  for (std::size_t i = 0; i < 10 * FrameLedger::kMostUnderWay; ++i) {
    const auto kept = ledger.open();
    ledger.settle(ledger.open(), Fate::kLate);
    ledger.settle(kept, Fate::kShown);
  }
  EXPECT_EQ(ledger.counts().shown(), 10 * FrameLedger::kMostUnderWay);
  EXPECT_TRUE(ledger.counts().addsUp());
}

TEST(FrameLedgerDeathTest, RefusesToEndAFrameTwice) {
  FrameLedger ledger;
  const auto ticket = ledger.open();
  ledger.settle(ticket, Fate::kShown);
  EXPECT_DEATH(ledger.settle(ticket, Fate::kLate), "parts > 0");
}

TEST(FrameLedger, SumsUpInALine) {
  FrameLedger ledger;
  ledger.count(Fate::kShown, 90);
  ledger.count(Fate::kShownUntimely, 1);
  ledger.count(Fate::kReplaced, 2);
  ledger.count(Fate::kLate);
  EXPECT_EQ(
      ledger.counts().summary(3s),
      "showed 91 frames in 3.0 s (30.3 frames/s), 1 untimely; dropped 3 (1 late, 2 replaced by a "
      "newer one)");
}

TEST(FrameLedger, SumsUpInALineThatHasNoReasonsWhereNoneWasDropped) {
  FrameLedger ledger;
  ledger.count(Fate::kShown);
  EXPECT_EQ(ledger.counts().summary(1s), "showed 1 frame in 1.0 s (1.0 frames/s); dropped 0");
}

TEST(Fates, HaveNamesOfTheirOwn) {
  std::set<std::string_view> names, texts;
  for (const Fate fate : allFates()) {
    names.insert(nameOf(fate));
    texts.insert(describe(fate));
  }
  EXPECT_EQ(names.size(), kFates);
  EXPECT_EQ(texts.size(), kFates);
}

TEST(Fates, AreDescribedWithoutWhatSeparatesThemInTheSummary) {
  for (const Fate fate : allFates()) {
    EXPECT_EQ(describe(fate).find_first_of(",:()0123456789"), std::string_view::npos)
        << describe(fate);
  }
}

}  // namespace
}  // namespace pleinair::runtime
