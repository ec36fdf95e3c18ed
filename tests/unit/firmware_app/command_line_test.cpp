#include "firmware_app/command_line.h"

#include <algorithm>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pleinair::app {
namespace {

using testing::HasSubstr;

struct Outcome {
  int status;
  std::string output;
  std::string error;
};

Outcome run(std::vector<const char*> arguments) {
  arguments.insert(arguments.begin(), "pleinair");
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  const int status = runCommandLine(static_cast<int>(arguments.size()), arguments.data());
  return {status, testing::internal::GetCapturedStdout(), testing::internal::GetCapturedStderr()};
}

/// Expects status 2, nothing on standard output, and one line on standard error that says `what`.
void expectRefused(const std::vector<const char*>& arguments, const std::string& what) {
  const Outcome refused = run(arguments);
  EXPECT_EQ(refused.status, 2) << refused.error;
  EXPECT_EQ(refused.output, "");
  EXPECT_THAT(refused.error, testing::StartsWith("pleinair: "));
  EXPECT_THAT(refused.error, HasSubstr(what));
  EXPECT_EQ(std::ranges::count(refused.error, '\n'), 1) << refused.error;
  EXPECT_EQ(refused.error.back(), '\n');
}

TEST(CommandLine, RefusesWhatItDoesNotKnow) {
  expectRefused({}, "one of render, record and styles is required");
  expectRefused({"paint"}, "paint");
  expectRefused({"--verbose"}, "--verbose");
  expectRefused({"styles", "styles"}, "styles");
  expectRefused({"render", "--input", "a.mp4", "--output", "b.mp4", "--colour"}, "--colour");
  expectRefused({"record", "--output", "b.mp4", "two\nlines"}, "two?lines");
  expectRefused({"record", "--output", "/no-such-folder/b.mp4", "--camera", "webcam"},
                "unknown camera \"webcam\"; allowed: synthetic");
}

TEST(CommandLine, NamesWhatIsMissing) {
  expectRefused({"render"}, "--input");
  expectRefused({"render", "--input", "a.mp4"}, "--output");
  expectRefused({"record"}, "--output");
  expectRefused({"render", "--input", "/no-such-folder/a.mp4", "--output", "b.mp4"},
                "/no-such-folder/a.mp4");
}

TEST(CommandLine, RefusesValuesOutOfRange) {
  for (const char* size :
       {"640", "640x", "x480", "640x480x3", "0x480", "-640x480", "9000x9000", "8192x8192", "wide",
        "640x480 ", "640x 480", " 640x480", "+640x480", "640x+480", "640X480", "99999999999x480"}) {
    expectRefused({"record", "--output", "b.mp4", "--size", size}, "WIDTHxHEIGHT");
  }
  for (const char* frames : {"0", "-3", "many", "1.5"}) {
    expectRefused({"record", "--output", "b.mp4", "--frames", frames}, "--frames");
  }
  expectRefused({"record", "--output", "b.mp4", "--seed", "-1"}, "--seed");
}

TEST(CommandLine, HelpsAndTellsItsVersion) {
  const Outcome help = run({"--help"});
  EXPECT_EQ(help.status, 0);
  EXPECT_EQ(help.error, "");
  for (const std::string command : {"render", "record", "styles"}) {
    EXPECT_THAT(help.output, HasSubstr(command));
  }
  const Outcome renderHelp = run({"render", "--help"});
  EXPECT_EQ(renderHelp.status, 0);
  for (const std::string option :
       {"--input", "--output", "--style", "--set", "--view", "--scene", "--size", "--frames",
        "--poses", "--contact-sheet", "--shaders"}) {
    EXPECT_THAT(renderHelp.output, HasSubstr(option));
  }
  const Outcome version = run({"--version"});
  EXPECT_EQ(version.status, 0);
  EXPECT_THAT(version.output, testing::ContainsRegex("[0-9]+\\.[0-9]+\\.[0-9]+"));
}

}  // namespace
}  // namespace pleinair::app
