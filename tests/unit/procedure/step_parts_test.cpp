#include "pipeline/procedure/step_parts.h"

#include <gmock/gmock.h>

#include "tests/unit/procedure/procedure_texts.h"

namespace pleinair::procedure {
namespace {

using testing::HasSubstr;

TEST(StepParts, PartsThatAreOffOrOnAlreadyAreFound) {
  const std::string off = messagesOfSteps(
      "[[step]]\nid = \"a\"\nremoves = [\"cover\"]\n[[step]]\nid = \"b\"\nparts = [\"cover\"]\n",
      {"a", "b"});
  EXPECT_THAT(off, HasSubstr("p.toml:10: step[1]: shows \"cover\", off by then"));
  const std::string on = messagesOfSteps("[[step]]\nid = \"a\"\nfits = [\"cover\"]\n", {"a"});
  EXPECT_THAT(on, HasSubstr("p.toml:7: step[0]: fits \"cover\", on already"));
  EXPECT_EQ(
      messagesOfSteps(
          "[[step]]\nid = \"a\"\nremoves = [\"cover\"]\n[[step]]\nid = \"b\"\nfits = [\"cover\"]\n"
          "[[step]]\nid = \"c\"\nparts = [\"cover\"]\n",
          {"a", "b", "c"}),
      "");
}

TEST(StepParts, AGotoBackToAStepWhosePartIsOffIsFound) {
  const std::string toml =
      "[[step]]\nid = \"a\"\nremoves = [\"cover\"]\n[[step]]\nid = \"b\"\n"
      "check = { kind = \"value\", unit = \"mm\", min = 1 }\ngoto = { low = \"a\" }\n"
      "[[step]]\nid = \"c\"\nfits = [\"cover\"]\n";
  const auto messagesWith = [&](const std::string& steps) {
    return messagesOf(readSteps(steps, {"a", "b", "c"}, "? Gap"));
  };
  EXPECT_THAT(
      messagesWith(toml),
      HasSubstr(
          "p.toml:10: step[1]: \"low\" leads to \"a\", which removes \"cover\", off by then"));
  std::string back = toml;  // by way of the step that fits it
  back.replace(back.find("low = \"a\""), 9, "low = \"c\"");
  EXPECT_THAT(messagesWith(back), testing::Not(HasSubstr("off by then")));
  std::string again = toml;  // the step that is done again is none that was left
  again.replace(again.find("low = \"a\""), 9, "low = \"b\"");
  EXPECT_THAT(messagesWith(again), testing::Not(HasSubstr("off by then")));
}

TEST(StepParts, APartThatOneWayLeavesOnMayBeShown) {
  const std::string steps =
      "[[step]]\nid = \"a\"\ncheck = \"photo\"\n[[step]]\nid = \"b\"\nremoves = [\"cover\"]\n"
      "[[step]]\nid = \"c\"\nparts = [\"cover\"]\n";
  EXPECT_THAT(messagesOfSteps(steps, {"a", "b", "c"}), HasSubstr("off by then"));
  const std::string branched =
      "[[step]]\nid = \"a\"\ncheck = { kind = \"value\", unit = \"mm\", min = 1 }\n"
      "goto = { low = \"c\" }\n[[step]]\nid = \"b\"\nremoves = [\"cover\"]\n"
      "[[step]]\nid = \"c\"\nparts = [\"cover\"]\n";
  EXPECT_THAT(messagesOfSteps(branched, {"a", "b", "c"}), testing::Not(HasSubstr("off by then")));
}

/// A procedure that takes the cover off, looks, and puts it back, with these branches at the end.
std::string coverProcedure(const std::string& branches) {
  return "[[step]]\nid = \"off\"\nremoves = [\"cover\"]\n"
         "[[step]]\nid = \"inside\"\nparts = [\"shaft\"]\n"
         "[[step]]\nid = \"on\"\nfits = [\"cover\"]\n"
         "[[step]]\nid = \"test\"\ncheck = \"yes_no\"\n" +
         branches;
}

std::string messagesOfCover(const std::string& branches) {
  MemorySources sources;
  sources.texts["en.md"] =
      "# T\n## off: Off\nx\n## inside: Inside\nx\n## on: On\nx\n## test: Test\n? Runs\n";
  return messagesOf(readProcedure(kHead + coverProcedure(branches), "p.toml", sources));
}

TEST(StepParts, AWayBackHasToMeetThePartsAsTheyAreByThen) {
  EXPECT_EQ(messagesOfCover("goto = { no = \"off\" }\n"), "") << "the cover is on, and comes off";
  EXPECT_THAT(messagesOfCover("goto = { no = \"inside\" }\n"),
              HasSubstr("p.toml:16: step[3]: \"no\" leads to \"inside\", and on to \"on\", which "
                        "fits \"cover\", on already, allowed: a way on which a step removes"));
  EXPECT_THAT(messagesOfCover("goto = { no = \"on\" }\n"),
              HasSubstr("p.toml:16: step[3]: \"no\" leads to \"on\", which fits \"cover\", on "
                        "already, allowed: a way on which a step removes the part"));
}

TEST(StepParts, AWayThatAnAnswerMayExcludeIsAWarning) {
  MemorySources sources;
  sources.texts["en.md"] =
      "# T\n## a: Guard\n? Is there one\n## b: Off\nx\n## c: Oil\nx\n## d: Guard\n? Was there "
      "one\n## e: On\nx\n";
  const ProcedureReading reading =
      readProcedure(kHead +
                        "[[step]]\nid = \"a\"\ncheck = \"yes_no\"\ngoto = { no = \"c\" }\n"
                        "[[step]]\nid = \"b\"\nremoves = [\"cover\"]\n"
                        "[[step]]\nid = \"c\"\nparts = [\"plug\"]\n"
                        "[[step]]\nid = \"d\"\ncheck = \"yes_no\"\ngoto = { no = \"end\" }\n"
                        "[[step]]\nid = \"e\"\nfits = [\"cover\"]\n",
                    "p.toml", sources);
  EXPECT_EQ(messagesOf(reading), "");
  ASSERT_EQ(reading.warnings.size(), 1U);
  EXPECT_THAT(
      reading.warnings[0].what(),
      HasSubstr("\"no\" leads to \"c\", and on to \"e\", which fits \"cover\", on already"));
}

TEST(StepParts, WhatIsOffAtTheEndIsKnown) {
  MemorySources sources;
  sources.texts["en.md"] = "# T\n## a: A\nx\n## b: B\n? Worn\n## c: C\nx\n";
  const ProcedureReading reading =
      readProcedure(kHead +
                        "[[step]]\nid = \"a\"\nremoves = [\"cover\", \"plug\"]\n"
                        "[[step]]\nid = \"b\"\ncheck = \"yes_no\"\ngoto = { no = \"end\" }\n"
                        "[[step]]\nid = \"c\"\nfits = [\"cover\"]\n",
                    "p.toml", sources);
  ASSERT_EQ(messagesOf(reading), "");
  const PartsLeftOff left = partsLeftOff(reading.procedure);
  EXPECT_THAT(left.onEveryWay, testing::ElementsAre(0)) << "the plug";
  EXPECT_THAT(left.onSomeWays, testing::ElementsAre(1)) << "the cover";
}

}  // namespace
}  // namespace pleinair::procedure
