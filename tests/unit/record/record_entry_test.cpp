#include "pipeline/record/record_entry.h"

#include <gmock/gmock.h>

#include "pipeline/digest/sha256.h"

namespace pleinair::record {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

RecordEntry entryWith(Event event) {
  return {.number = 7,
          .previous = std::string(64, 'b'),
          .moment = {.wall = WallTime(std::chrono::milliseconds(1'732'418'504'123)),
                     .monotonic = std::chrono::milliseconds(4200),
                     .boot = "id"},
          .event = std::move(event)};
}

RecordEntry readBack(RecordEntry entry) {
  std::string line = lineOf(entry);
  EXPECT_TRUE(line.ends_with("\"}\n"));
  line.pop_back();
  auto read = entryOf(line);
  EXPECT_TRUE(read) << read.error().problem << '\n' << line;
  return read.value();
}

TEST(RecordEntry, IsJsonWhoseHashIsThatOfWhatIsBeforeIt) {
  RecordEntry entry = entryWith(OperatorChanged{.operatorName = "Jo \"J\"\n"});
  const std::string line = lineOf(entry);
  EXPECT_THAT(line, StartsWith("{\"n\":7,\"prev\":\"bbb"));
  EXPECT_THAT(line, HasSubstr("\"wall\":\"2024-11-24T03:21:44.123Z\",\"clock\":\"untrusted\","
                              "\"monotonic_ms\":4200,\"boot\":\"id\",\"type\":\"operator\","
                              "\"operator\":\"Jo \\\"J\\\"\\n\",\"hash\":\""));
  const std::string body = line.substr(0, line.find(",\"hash\":"));
  EXPECT_EQ(entry.hash, digest::hexOf(digest::sha256(body)));
  EXPECT_EQ(std::count(line.begin(), line.end(), '\n'), 1);
}

TEST(RecordEntry, IsReadAsItWasWritten) {
  const RecordEntry step = readBack(entryWith(StepDone{.step = "gap",
                                                       .outcome = procedure::Outcome::kHigh,
                                                       .value = 0.1 + 0.2,
                                                       .unit = "mm",
                                                       .took = std::chrono::milliseconds(1234),
                                                       .pose = PoseQuality{"carried", 0.5, 2.0},
                                                       .next = "end"}));
  const auto& done = std::get<StepDone>(step.event);
  EXPECT_EQ(step.number, 7U);
  EXPECT_EQ(step.moment.wall, entryWith(Resumed{}).moment.wall);
  EXPECT_EQ(done.outcome, procedure::Outcome::kHigh);
  EXPECT_EQ(done.value, 0.1 + 0.2) << "to the last bit";
  EXPECT_EQ(done.unit, "mm");
  EXPECT_EQ(done.took.count(), 1234);
  EXPECT_EQ(done.pose->source, "carried");
  EXPECT_EQ(done.next, "end");
  const RecordEntry still =
      readBack(entryWith(StillTaken{"a", "before", "w.stills/1.png", "cc", 1U << 31U}));
  EXPECT_EQ(std::get<StillTaken>(still.event).bytes, 1U << 31U);
  EXPECT_EQ(std::get<Resumed>(readBack(entryWith(Resumed{.cutBytes = 3})).event).cutBytes, 3U);
  EXPECT_EQ(
      std::get<SignedOff>(readBack(entryWith(SignedOff{.result = SignOff::kAborted})).event).result,
      SignOff::kAborted);
  EXPECT_EQ(std::get<SteppedBack>(readBack(entryWith(SteppedBack{"b", "a"})).event).next, "a");
}

TEST(RecordEntry, BytesThatAreNoUtf8AreReplaced) {
  const RecordEntry entry = readBack(entryWith(OperatorChanged{.operatorName = "J\xff"}));
  EXPECT_EQ(std::get<OperatorChanged>(entry.event).operatorName, "J\xEF\xBF\xBD");
}

/// A line with a valid hash over any body.
std::string hashed(const std::string& body) {
  return body + ",\"hash\":\"" + digest::hexOf(digest::sha256(body)) + "\"}";
}

TEST(RecordEntry, WhatIsNoLineIsRefused) {
  EXPECT_THAT(entryOf("").error().problem, HasSubstr("is no line"));
  EXPECT_THAT(entryOf(std::string(200, 'x')).error().problem,
              HasSubstr("does not end with a hash"));
  EXPECT_THAT(entryOf(hashed("[1")).error().problem, HasSubstr("is no JSON object"));
  EXPECT_THAT(entryOf(hashed("{\"n\":\"x\"")).error().problem, HasSubstr("cannot be read"));
  EXPECT_THAT(entryOf(hashed("{\"n\":0,\"prev\":\"\",\"wall\":\"2024-13-41T00:00:00.000Z\""))
                  .error()
                  .problem,
              HasSubstr("has no valid time"));
  EXPECT_THAT(
      entryOf(hashed("{\"n\":0,\"prev\":\"\",\"wall\":\"2024-11-24T00:00:00.000Z\",\"clock\":"
                     "\"trusted\",\"monotonic_ms\":1,\"boot\":\"\",\"type\":\"coffee\""))
          .error()
          .problem,
      HasSubstr("an unknown type"));
}

TEST(SystemMoment, MovesOnAndKnowsTheBoot) {
  const Moment first = systemMoment();
  const Moment second = systemMoment();
  EXPECT_LE(first.monotonic, second.monotonic);
  EXPECT_GT(first.monotonic.count(), 0);
  EXPECT_EQ(first.boot, second.boot);
  EXPECT_EQ(first.boot.size(), 32U);
}

}  // namespace
}  // namespace pleinair::record
