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
  ledger.count(Outcome::kCorrupt, 3);
  EXPECT_EQ(ledger.counts().inFlight, 2u);
  ledger.end(first, Outcome::kShown);
  ledger.end(second, Outcome::kReplaced);
  const LedgerCounts counts = ledger.counts();
  EXPECT_EQ(counts.captured, 5u);
  EXPECT_EQ(counts.inFlight, 0u);
  EXPECT_EQ(counts.of(Outcome::kShown), 1u);
  EXPECT_EQ(counts.of(Outcome::kReplaced), 1u);
  EXPECT_EQ(counts.of(Outcome::kCorrupt), 3u);
  EXPECT_EQ(counts.dropped(), 4u);
  EXPECT_TRUE(counts.addsUp());
}

TEST(FrameLedger, GivesAFrameOfSeveralOutputsItsBestOutcome) {
  FrameLedger ledger;
  const auto ticket = ledger.open();
  ledger.split(ticket, 3);
  ledger.end(ticket, Outcome::kOutputBusy);
  ledger.end(ticket, Outcome::kShown);
  EXPECT_EQ(ledger.counts().inFlight, 1u);
  ledger.end(ticket, Outcome::kLate);
  EXPECT_EQ(ledger.counts().of(Outcome::kShown), 1u);
  EXPECT_EQ(ledger.counts().dropped(), 0u);
  EXPECT_TRUE(ledger.counts().addsUp());
}

TEST(FrameLedger, UsesItsSlotsAgain) {
  FrameLedger ledger;
  for (std::size_t i = 0; i < 10 * FrameLedger::kMaxInFlight; ++i) {
    const auto kept = ledger.open();
    ledger.end(ledger.open(), Outcome::kLate);
    ledger.end(kept, Outcome::kShown);
  }
  EXPECT_EQ(ledger.counts().shown(), 10 * FrameLedger::kMaxInFlight);
  EXPECT_TRUE(ledger.counts().addsUp());
}

TEST(FrameLedgerDeathTest, RefusesToEndAFrameTwice) {
  FrameLedger ledger;
  const auto ticket = ledger.open();
  ledger.end(ticket, Outcome::kShown);
  EXPECT_DEATH(ledger.end(ticket, Outcome::kLate), "parts > 0");
}

TEST(FrameLedger, SumsUpInALine) {
  FrameLedger ledger;
  ledger.count(Outcome::kShown, 90);
  ledger.count(Outcome::kShownOffSchedule, 1);
  ledger.count(Outcome::kReplaced, 2);
  ledger.count(Outcome::kLate);
  EXPECT_EQ(ledger.counts().summary(3s),
            "showed 91 frames in 3.0 s (30.3 frames/s), 1 off schedule; dropped 3 (1 late, 2 "
            "replaced by a "
            "newer one)");
}

TEST(FrameLedger, SumsUpInALineThatHasNoReasonsWhereNoneWasDropped) {
  FrameLedger ledger;
  ledger.count(Outcome::kShown);
  EXPECT_EQ(ledger.counts().summary(1s), "showed 1 frame in 1.0 s (1.0 frames/s); dropped 0");
}

TEST(Outcomes, HaveNamesOfTheirOwn) {
  std::set<std::string_view> names, texts;
  for (const Outcome outcome : allOutcomes()) {
    names.insert(nameOf(outcome));
    texts.insert(describe(outcome));
  }
  EXPECT_EQ(names.size(), kOutcomes);
  EXPECT_EQ(texts.size(), kOutcomes);
}

TEST(Outcomes, AreDescribedWithoutWhatSeparatesThemInTheSummary) {
  for (const Outcome outcome : allOutcomes()) {
    EXPECT_EQ(describe(outcome).find_first_of(",:()0123456789"), std::string_view::npos)
        << describe(outcome);
  }
}

}  // namespace
}  // namespace pleinair::runtime
