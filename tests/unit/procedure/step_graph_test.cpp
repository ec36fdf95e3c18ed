#include "pipeline/procedure/step_graph.h"

#include <gmock/gmock.h>

#include "tests/unit/procedure/procedure_texts.h"

namespace pleinair::procedure {
namespace {

using testing::HasSubstr;

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

}  // namespace
}  // namespace pleinair::procedure
