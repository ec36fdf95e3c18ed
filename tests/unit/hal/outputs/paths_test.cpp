#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/numbered_path.h"
#include "hal/outputs/registry.h"
#include "tests/support/media_files.h"
#include "tests/support/temporary_folder.h"

namespace pleinair::hal {
namespace {

TEST(NumberedPath, WritesAndReadsItsNumbers) {
  const Result<NumberedPath> path = NumberedPath::parse("out/a%04d%%.png");
  ASSERT_TRUE(path);
  EXPECT_EQ(path->at(7), "out/a0007%.png");
  EXPECT_EQ(path->at(123456), "out/a123456%.png");
  EXPECT_EQ(path->numberOf("a0007%.png"), 7u);
  EXPECT_EQ(path->numberOf("a123456%.png"), 123456u);
  for (const char* other : {"a7%.png", "a00007%.png", "a%.png", "b0007%.png", "a-007%.png"}) {
    EXPECT_EQ(path->numberOf(other), std::nullopt) << other;
  }
}

TEST(NumberedPath, IsNeverPrintfs) {
  for (const char* pattern : {"%s.png", "%n.png", "%04x.png", "%d%d.png", "a.png", "%.png",
                              "%5d.png", "%0d.png", "%019d.png", "%00d.png", "%d/a.png",
                              "%999999999999d.png", "%-4d.png", "%ld.png", "%", "%0", "%04"}) {
    const Result<NumberedPath> path = NumberedPath::parse(pattern);
    ASSERT_FALSE(path) << pattern;
    EXPECT_EQ(path.error().kind, ErrorKind::kInvalidArgument);
    EXPECT_THAT(path.error().message(), testing::HasSubstr("%04d"));
  }
}

TEST(OpenFileOutput, ChoosesByThePath) {
  const support::TemporaryFolder folder;
  for (const auto& [path, backend] : {std::pair{"a.mp4", "movie"},
                                      {"a.MKV", "movie"},
                                      {"a.y4m", "movie"},
                                      {"a.png", "frames"},
                                      {"a/", "frames"},
                                      {"a", "frames"},
                                      {"%04d.png", "frames"},
                                      {".", "frames"}}) {
    const auto output = openFileOutput(folder.path() / path);
    ASSERT_TRUE(output) << path;
    EXPECT_EQ((*output)->identity().backend, backend) << path;
  }
  for (const char* path : {"a.avi", "a.gif", "a.mp4.txt", ""}) {
    const auto output = openFileOutput(path);
    ASSERT_FALSE(output) << path;
    EXPECT_EQ(output.error().kind, ErrorKind::kInvalidArgument);
    EXPECT_THAT(output.error().message(),
                testing::HasSubstr(".mp4, .mkv, .y4m, .png, .jpg, .jpeg, .tif or .tiff"));
  }
}

TEST(OutputRegistry, ChoosesTheKindByTheTarget) {
  const support::TemporaryFolder folder;
  for (const auto& [target, kind] : {std::pair{"window", "window"},
                                     {"headless", "headless"},
                                     {"loopback", "loopback"},
                                     {"loopback:/dev/video50", "loopback"},
                                     {"loopback:a card", "loopback"},
                                     {"loopback.mp4", "movie"},
                                     {"./window", "frames"},
                                     {"window/", "frames"},
                                     {".", "frames"},
                                     {"..", "frames"},
                                     {"a/b", "frames"},
                                     {"%04d.png", "frames"}}) {
    const auto found = outputKindOf(target);
    ASSERT_TRUE(found) << target << ": " << found.error().message();
    EXPECT_EQ((*found)->name, kind) << target;
  }
}

TEST(OutputRegistry, RefusesABareWordThatIsNoKind) {
  for (const std::string word : {"screen", "Window", "screen:HDMI-A-1", "out"}) {
    for (const hal::Error& error :
         {outputKindOf(word).error(), openOutput(word).error(), openFileOutput(word).error()}) {
      EXPECT_EQ(error.kind, ErrorKind::kInvalidArgument);
      EXPECT_THAT(error.message(), testing::HasSubstr("./" + word + " or " + word + "/"));
    }
    const std::string live = "window, display, display:CONNECTOR, loopback, loopback:DEVICE";
    EXPECT_THAT(openOutput(word).error().message(), testing::HasSubstr(live));
    EXPECT_THAT(openFileOutput(word).error().message(),
                testing::AllOf(testing::HasSubstr("end it in .mp4, .mkv, .y4m, .png"),
                               testing::Not(testing::HasSubstr("display"))));
  }
  EXPECT_THAT(openFileOutput("window").error().message(), testing::HasSubstr("is no file"));
}

TEST(OutputRegistry, ListsKindsWhoseFormsAreTheirs) {
  for (const OutputKind& kind : outputKinds()) {
    EXPECT_FALSE(kind.help.empty()) << kind.name;
    EXPECT_EQ(kind.list == nullptr, kind.traits.writesFiles) << kind.name;
    for (const std::string& form : kind.forms) {
      const auto found = outputKindOf(form);
      ASSERT_TRUE(found) << form;
      EXPECT_EQ((*found)->name, kind.name) << form;
    }
    for (const OutputOption& option : kind.options) {
      if (option.isSwitch) continue;
      if (!option.choices.empty()) {
        EXPECT_GE(option.choices.size(), 2u) << option.name;
        continue;
      }
      EXPECT_TRUE(option.takes(option.initial)) << option.name;
      EXPECT_FALSE(option.allowed.empty()) << option.name;
    }
  }
  EXPECT_THAT(outputWords(), testing::ElementsAre("window", "display", "loopback", "headless"));
  EXPECT_THAT(outputPrefixes(), testing::ElementsAre("display:CONNECTOR", "loopback:DEVICE"));
}

TEST(OutputRegistry, GivesAKindItsOptions) {
  EXPECT_TRUE(openOutput("loopback", {{"loopback", {{"format", "nv12"}}}}));
  const auto refused = openOutput("loopback", {{"loopback", {{"format", "rgb"}}}});
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message(), testing::HasSubstr("yuyv, nv12 or i420"));
}

TEST(FramesOutput, MakesItsFolderButNotItsParents) {
  const support::TemporaryFolder folder;
  support::writeMedia(folder.path() / "new", 2);
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "new" / "000000.png"));
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "new" / "000001.png"));
  const auto output = openFileOutput(folder.path() / "no" / "parent");
  ASSERT_TRUE(output);
  const Result<OutputFormat> started = (*output)->start({.size = {4, 4}});
  ASSERT_FALSE(started);
  EXPECT_EQ(started.error().kind, ErrorKind::kNotFound) << started.error().message();
}

TEST(FramesOutput, RefusesASecondPictureForOneName) {
  const support::TemporaryFolder folder;
  {
    const auto output = orThrow(openFileOutput(folder.path() / "one.png"));
    const FrameFormat format = orThrow(output->start({.size = {4, 4}})).frame;
    EXPECT_TRUE(output->write(support::testPicture(format, 0).view(), Duration(0)));
    const Result<void> second = output->write(support::testPicture(format, 1).view(), Duration(1));
    ASSERT_FALSE(second);
    EXPECT_THAT(second.error().message(), testing::HasSubstr("%04d.png"));
  }
  EXPECT_EQ(folder.entryCount(), 0u);
}

TEST(Outputs, SayThatTheFolderIsMissing) {
  for (const char* path : {"/nonexistent-folder/a.mp4", "/nonexistent-folder/%d.png"}) {
    const auto output = orThrow(openFileOutput(path));
    const Result<OutputFormat> started = output->start({.size = {4, 4}});
    ASSERT_FALSE(started);
    EXPECT_EQ(started.error().kind, ErrorKind::kNotFound) << started.error().message();
  }
}

TEST(FileOutput, IsNotMadeAmongDevices) {
  const auto opened = openFileOutput("/dev/video7");
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().kind, ErrorKind::kInvalidArgument);
  EXPECT_NE(opened.error().remedy.find("loopback:/dev/video7"), std::string::npos);
}

}  // namespace
}  // namespace pleinair::hal
