#include "firmware_app/command_line.h"

#include <algorithm>
#include <chrono>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "firmware_app/cli/option_values.h"

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
  expectRefused(
      {},
      "one of run, rescue, render, record, looks, scene, tags, procedure, "
      "record-check, record-export, inputs, calibrate, measure, config, devices, doctor, warm-up, "
      "thesis and styles is required");
  expectRefused({"paint"}, "paint");
  expectRefused({"--verbose"}, "--verbose");
  expectRefused({"styles", "styles"}, "styles");
  expectRefused({"render", "--input", "a.mp4", "--output", "b.mp4", "--colour"}, "--colour");
  expectRefused({"record", "--output", "b.mp4", "two\nlines"}, "two?lines");
  expectRefused({"record", "--output", "/no-such-folder/b.mp4", "--camera", "webcam"}, "webcam");
  for (const char* camera : {"synthetic:x", "synthetic:zoom", "synthetic:", "synthetic:pann"}) {
    expectRefused(
        {"record", "--output", "/no-such-folder/b.mp4", "--camera", camera},
        "synthetic, synthetic:walkaround, synthetic:pan, synthetic:dolly, synthetic:roll, "
        "synthetic:still, synthetic:occluder, synthetic:cut, synthetic:visitors, synthetic:lights, "
        "synthetic:hand, synthetic:crossing, synthetic:portrait");
  }
}

TEST(CommandLine, ReadsTimesOfRecordings) {
  using std::chrono_literals::operator""ms;
  EXPECT_EQ(timeOf("--at", "12.5"), 12500ms);
  EXPECT_EQ(timeOf("--at", "1:02.5"), 62500ms);
  EXPECT_EQ(timeOf("--at", "1:00:02"), 3602000ms);
  EXPECT_EQ(timeOf("--at", "90:00"), 5400000ms);
  for (const char* wrong : {"", "x", "-1", "1:60", "1.5:02", "1:2:3:4", "1:", ":5", "12,5"}) {
    EXPECT_THROW(timeOf("--at", wrong), CLI::ValidationError) << wrong;
  }
}

TEST(CommandLine, NamesOnlyTheShotsWhereAShotIsUnknown) {
  const Outcome refused = run({"measure", "--camera", "synthetic:nope"});
  EXPECT_EQ(refused.status, 2);
  EXPECT_EQ(
      refused.error,
      "pleinair: --camera: found \"synthetic:nope\", allowed: synthetic, synthetic:walkaround, "
      "synthetic:pan, synthetic:dolly, synthetic:roll, synthetic:still, synthetic:occluder, "
      "synthetic:cut, synthetic:visitors, synthetic:lights, synthetic:hand, "
      "synthetic:crossing, synthetic:portrait\n");
}

TEST(CommandLine, PointsToTheHelpOfTheSubcommand) {
  expectRefused({"measure", "--frob"}, "; see pleinair measure --help");
  expectRefused({"measure", "--frames", "0"}, "; see pleinair measure --help");
  expectRefused({"render", "--colour"}, "; see pleinair render --help");
  expectRefused({"scene", "check"}, "; see pleinair scene check --help");
  expectRefused({"paint"}, "; see pleinair --help");
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
  for (const std::string frames : {"0", "-3", "+3", "two", "1.5", "3 ", "99999999999999999999"}) {
    const std::string what =
        "--frames: found \"" + frames + "\", allowed: a whole number from 1 to 1000000000;";
    expectRefused({"record", "--output", "b.mp4", "--frames", frames.c_str()}, what);
    expectRefused({"render", "--input", "a.mp4", "--output", "b.mp4", "--frames", frames.c_str()},
                  what);
  }
  expectRefused({"record", "--output", "b.mp4", "--seed", "-1"}, "--seed");
  expectRefused({"measure", "--settle", "-1"},
                "--settle: found \"-1\", allowed: a whole number from 0 to 1000000000;");
  for (const std::string pan : {"1", "1,2,3", "1,", ",", "a,1", "1,41", "nan,0"}) {
    expectRefused({"measure", "--input", "a.png", "--pan", pan.c_str()},
                  "--pan: found \"" + pan + "\", allowed: two numbers from -40 to 40");
  }
}

TEST(CommandLine, NamesWhatItDoesNotKnowBeforeWhatIsMissing) {
  expectRefused({"render", "--inpt", "C", "--output", "x.png"},
                "--inpt: unknown option (did you mean \"--input\"?);");
  expectRefused({"render", "--inpt=C", "--output", "x.png"},
                "--inpt: unknown option (did you mean \"--input\"?);");
  expectRefused({"rendr"}, "rendr: unknown command (did you mean \"render\"?);");
  expectRefused({"--versoin"}, "--versoin: unknown option (did you mean \"--version\"?);");
}

TEST(CommandLine, SaysHowARecordingIsGiven) {
  expectRefused({"run", "bench.mp4"},
                "bench.mp4: unexpected argument: `pleinair run` takes a camera or a recording as "
                "--camera NAME|FILE; `pleinair render FILE` paints every frame of a recording;");
  expectRefused({"run", "--input", "bench.mp4"}, "--input: `pleinair run` takes a camera or a");
  expectRefused({"record", "bench.mp4", "--output", "b.mp4"}, "`pleinair record` takes a camera");
  expectRefused({"render", "--camera", "synthetic", "--output", "b.mp4"},
                "--camera: `pleinair render` takes a recording, as FILE; `pleinair run` paints a "
                "camera, `pleinair record` records one;");
  expectRefused({"calibrate", "board.mp4", "--board", "checkerboard:9x6", "--output", "c.toml"},
                "board.mp4: unexpected argument: give a recording as --input FILE;");
}

TEST(CommandLine, RefusesACalibrationWithoutACamera) {
  expectRefused({"calibrate", "--board", "checkerboard:9x6", "--square", "0.02", "--output",
                 "/no-such-folder/c.toml"},
                "calibrate: is given no camera; give one, such as --camera auto, or a recording as "
                "--input FILE");
}

TEST(CommandLine, RefusesAPartThatEndsBeforeItBegins) {
  for (const char* end : {"1", "3"}) {
    expectRefused({"render", "a.mp4", "--output", "b.mp4", "--from", "3", "--to", end},
                  std::string("--to: ends at ") + end + " s, and --from begins at 3 s");
  }
}

TEST(CommandLine, KnowsTheRangesAndOtherNamesOfCodecs) {
  const auto refused = [](const std::vector<const char*>& options, const std::string& what) {
    std::vector<const char*> arguments{"render", "a.mp4", "--output", "b.mp4"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    expectRefused(arguments, what);
  };
  refused({"--crf", "99"}, "--crf: found \"99\", allowed: a number from 0 to 51;");
  refused({"--crf", "64", "--codec", "av1"},
          "--crf: found \"64\", allowed: a number from 0 to 63;");
  refused({"--crf", "52", "--codec", "hevc"}, "a number from 0 to 51;");
  refused({"--crf", "63", "--codec", "av1"}, "a.mp4");
  refused({"--codec", "h265"},
          "--codec: found \"h265\" (did you mean \"hevc\"?), allowed: h264, hevc, av1, ffv1;");
  refused({"--codec", "ffv"}, "(did you mean \"ffv1\"?)");
}

TEST(CommandLine, RefusesAFigureThatIsNotTheThesiss) {
  expectRefused({"thesis", "--output", "/dev/null/r", "--only", "99"},
                "--only: there is no figure \"99\"; give 15_16_21, ");
  expectRefused({"thesis", "--output", "/dev/null/r", "--only", "16,26"},
                "/dev/null/r: is no folder");
}

TEST(CommandLine, RefusesEmptyValues) {
  for (const char* option : {"--input", "--output"}) {
    const char* other = std::string("--input") == option ? "--output" : "--input";
    expectRefused({"render", option, "", other, "a.mp4"},
                  std::string(option) + ": is empty, give it a value;");
  }
  expectRefused({"render", "--input=", "--output", "b.mp4"}, "--input: is empty, give it a value;");
  for (const char* option :
       {"--profile", "--config", "--scene", "--style", "--look", "--view", "--set", "--size",
        "--frames", "--poses", "--contact-sheet", "--shaders"}) {
    expectRefused({"render", "--input", "a.mp4", "--output", "b.mp4", option, ""},
                  std::string(option) + ": is empty, give it a value or leave it out");
  }
}

TEST(CommandLine, RefusesNamesThatWouldNotHoldWhatIsWritten) {
  for (const char* name : {"sheet.jpg", "sheet", ".png", "-"}) {
    expectRefused(
        {"render", "--input", "a.mp4", "--output", "b.mp4", "--contact-sheet", name},
        "--contact-sheet: found \"" + std::string(name) + "\", allowed: a name that ends in .png");
  }
  const std::string what = ": found \"-\", allowed: the name of a file;";
  expectRefused({"record", "--output", "-"}, "--output" + what);
  expectRefused({"render", "--input", "a.mp4", "--output", "b.mp4", "--poses", "-"},
                "--poses" + what);
}

TEST(CommandLine, ChecksWhatRunIsGivenBeforeItOpensAnything) {
  expectRefused({"run", "--camera", "webcam"},
                "webcam: is neither a camera nor a file; choose auto, ");
  expectRefused({"run", "--output", "out.avi"}, "out.avi: does not say what to write");
  expectRefused({"run", "--output", "-"}, "--output: found \"-\"");
  expectRefused({"run", "--snapshots", "/no-such-folder"}, "/no-such-folder: is not a folder");
  expectRefused({"run", "--stills", "/tmp"},
                "--stills is now --snapshots; see pleinair run --help");
  expectRefused({"run", "--stills=/tmp"}, "--stills is now --snapshots; see pleinair run --help");
  expectRefused({"run", "--frames", "0"}, "--frames");
  expectRefused({"run", "--size", "0x0"}, "--size");
  for (const char* option : {"--camera", "--output", "--scene", "--style", "--view", "--set",
                             "--size", "--frames", "--snapshots", "--shaders"}) {
    expectRefused({"run", option, ""}, std::string(option) + ": is empty");
  }
}

TEST(CommandLine, HelpsAndTellsItsVersion) {
  const Outcome help = run({"--help"});
  EXPECT_EQ(help.status, 0);
  EXPECT_EQ(help.error, "");
  for (const std::string command : {"run", "render", "record", "config", "styles"}) {
    EXPECT_THAT(help.output, HasSubstr(command));
  }
  const Outcome renderHelp = run({"render", "--help"});
  EXPECT_EQ(renderHelp.status, 0);
  for (const std::string option :
       {"--input", "--output", "--profile", "--config", "--style", "--look", "--set", "--view",
        "--scene", "--size", "--frames", "--poses", "--contact-sheet", "--shaders"}) {
    EXPECT_THAT(renderHelp.output, HasSubstr(option));
  }
  EXPECT_THAT(renderHelp.output, HasSubstr("movies need even sides"));
  const Outcome runHelp = run({"run", "--help"});
  EXPECT_EQ(runHelp.status, 0);
  for (const std::string option : {"--camera", "--output", "--style", "--set", "--view", "--scene",
                                   "--size", "--frames", "--snapshots", "--shaders"}) {
    EXPECT_THAT(runHelp.output, HasSubstr(option));
  }
  EXPECT_EQ(run({"help"}).output, help.output);
  EXPECT_THAT(run({"help", "render"}).output, HasSubstr("Usage: pleinair render [OPTIONS] FILE"));
  const Outcome version = run({"--version"});
  EXPECT_EQ(version.status, 0);
  EXPECT_THAT(version.output, testing::ContainsRegex("[0-9]+\\.[0-9]+\\.[0-9]+"));
}

}  // namespace
}  // namespace pleinair::app
