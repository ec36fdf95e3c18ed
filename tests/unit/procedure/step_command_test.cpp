#include "pipeline/procedure/step_command.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>

namespace pleinair::procedure {
namespace {

using Kind = StepCommandKind;
using testing::HasSubstr;

TEST(StepCommand, IsReadAsItIsWritten) {
  for (const char* text : {"next", "back", "yes", "no", "uncertain", "photo", "value 0.15", "raw",
                           "operator J. Müller", "sign_off", "abort"}) {
    const auto command = parseStepCommand(text);
    ASSERT_TRUE(command) << text;
    EXPECT_EQ(textOf(*command), text);
  }
  EXPECT_EQ(parseStepCommand(" value  1,5\r\n")->value, 1.5);
  EXPECT_EQ(parseStepCommand("operator  K. Öz ")->operatorName, "K. Öz");
}

TEST(StepCommand, WhatIsNoneIsRefusedWithTheList) {
  for (const std::string& text :
       std::vector<std::string>{"", "nxt", "NEXT", "next now", "value", "value x", "value nan",
                                "value 1.5 mm", "operator", "next\nabort", "operator a\x07", "quit",
                                "operator " + std::string(300, 'x')}) {
    const auto command = parseStepCommand(text);
    ASSERT_FALSE(command) << text;
    EXPECT_THAT(command.error().remedy, HasSubstr("next, back, yes"));
  }
  EXPECT_THAT(parseStepCommand("nxt").error().problem, HasSubstr("did you mean \"next\""));
}

}  // namespace
}  // namespace pleinair::procedure
