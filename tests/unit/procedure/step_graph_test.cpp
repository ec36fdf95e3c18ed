#include "pipeline/procedure/step_graph.h"

#include <gmock/gmock.h>

#include "tests/unit/procedure/procedure_texts.h"

namespace pleinair::procedure {
namespace {

using testing::HasSubstr;

std::string messagesOfSteps(const std::string& steps, const std::vector<std::string>& ids) {
  return messagesOf(readSteps(steps, ids, ""));
}

TEST(StepGraph, AStepThatNothingLeadsToIsFound) {
  const std::string messages = messagesOfSteps(
      "[[step]]\nid = \"a\"\nnext = \"c\"\n[[step]]\nid = \"b\"\n[[step]]\nid = \"c\"\n",
      {"a", "b", "c"});
  EXPECT_EQ(
      messages,
      "p.toml:10: step[1]: \"b\" is never reached, allowed: a next or goto that leads to it\n");
}

TEST(StepGraph, ACycleWithoutExitIsFoundAndNamesItsSteps) {
  const std::string messages = messagesOfSteps(
      "[[step]]\nid = \"a\"\n[[step]]\nid = \"b\"\n[[step]]\nid = \"c\"\nnext = \"b\"\n",
      {"a", "b", "c"});
  EXPECT_EQ(
      messages,
      "p.toml:7: step[0]: no way leads from here to the end: a, b, c, allowed: a next or goto "
      "out of these steps, such as \"end\"\n");
}

TEST(StepGraph, ACycleWithAnExitIsAllowed) {
  const std::string steps =
      "[[step]]\nid = \"a\"\n[[step]]\nid = \"b\"\ncheck = \"yes_no\"\ngoto = { no = \"a\" }\n";
  EXPECT_EQ(
      messagesOf(readSteps(steps, {"a", "b"}, "? Sure?")),
      "en.md:2: step \"a\" has a question but no check, allowed: a check in the TOML file, or "
      "no line that begins with \"? \"\n");
}

TEST(StepGraph, PartsThatAreOffOrOnAlreadyAreFound) {
  const std::string off = messagesOfSteps(
      "[[step]]\nid = \"a\"\nremoves = [\"cover\"]\n[[step]]\nid = \"b\"\nparts = [\"cover\"]\n",
      {"a", "b"});
  EXPECT_THAT(off, HasSubstr("p.toml:10: step[1]: shows \"cover\", which is off by then"));
  const std::string on = messagesOfSteps("[[step]]\nid = \"a\"\nfits = [\"cover\"]\n", {"a"});
  EXPECT_THAT(on, HasSubstr("p.toml:7: step[0]: fits \"cover\", which is on already"));
  EXPECT_EQ(
      messagesOfSteps(
          "[[step]]\nid = \"a\"\nremoves = [\"cover\"]\n[[step]]\nid = \"b\"\nfits = [\"cover\"]\n"
          "[[step]]\nid = \"c\"\nparts = [\"cover\"]\n",
          {"a", "b", "c"}),
      "");
}

TEST(StepGraph, AGotoBackToAStepWhosePartIsOffIsFound) {
  const std::string toml =
      "[[step]]\nid = \"a\"\nremoves = [\"cover\"]\n[[step]]\nid = \"b\"\n"
      "check = { kind = \"value\", unit = \"mm\", min = 1 }\ngoto = { low = \"a\" }\n"
      "[[step]]\nid = \"c\"\nfits = [\"cover\"]\n";
  const auto messagesWith = [&](const std::string& steps) {
    return messagesOf(readSteps(steps, {"a", "b", "c"}, "? Gap"));
  };
  EXPECT_THAT(
      messagesWith(toml),
      HasSubstr("p.toml:10: step[1]: \"low\" leads to \"a\", whose \"cover\" is off by then"));
  std::string back = toml;  // by way of the step that fits it
  back.replace(back.find("low = \"a\""), 9, "low = \"c\"");
  EXPECT_THAT(messagesWith(back), testing::Not(HasSubstr("is off by then")));
  std::string again = toml;  // the step that is done again is none that was left
  again.replace(again.find("low = \"a\""), 9, "low = \"b\"");
  EXPECT_THAT(messagesWith(again), testing::Not(HasSubstr("is off by then")));
}

TEST(StepGraph, APartThatOneWayLeavesOnMayBeShown) {
  const std::string steps =
      "[[step]]\nid = \"a\"\ncheck = \"photo\"\n[[step]]\nid = \"b\"\nremoves = [\"cover\"]\n"
      "[[step]]\nid = \"c\"\nparts = [\"cover\"]\n";
  EXPECT_THAT(messagesOfSteps(steps, {"a", "b", "c"}), HasSubstr("which is off by then"));
  const std::string branched =
      "[[step]]\nid = \"a\"\ncheck = { kind = \"value\", unit = \"mm\", min = 1 }\n"
      "goto = { low = \"c\" }\n[[step]]\nid = \"b\"\nremoves = [\"cover\"]\n"
      "[[step]]\nid = \"c\"\nparts = [\"cover\"]\n";
  EXPECT_THAT(messagesOfSteps(branched, {"a", "b", "c"}),
              testing::Not(HasSubstr("which is off by then")));
}

}  // namespace
}  // namespace pleinair::procedure
