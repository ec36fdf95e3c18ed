// Whether what a configuration asks for is there.
#include "firmware_app/config/requested_parts.h"

#include <algorithm>

#include <gmock/gmock.h>

#include "hal/outputs/registry.h"
#include "tests/unit/firmware_app/configuration_test.h"

namespace pleinair::app {
namespace {

using testing::HasSubstr;

class RequestedPartsTest : public ConfigurationTest {
 protected:
  RequestedPartsTest() {
    request_.set = {"camera.source=synthetic", "output.targets=" + path("out.mp4").string()};
  }

  /// The problem of a part, in a line with its remedy; empty where there is none.
  std::string problemOf(const std::string& part) const {
    const std::vector<doctor::RequestedPart> parts = requestedParts(resolved());
    const auto found = std::ranges::find(parts, part, &doctor::RequestedPart::part);
    if (found == parts.end()) return "not judged";
    return found->problem ? found->problem->message() : "";
  }
};

TEST_F(RequestedPartsTest, AreAllThere) {
  for (const doctor::RequestedPart& part : requestedParts(resolved())) {
    EXPECT_FALSE(part.problem) << part.part << ": " << part.problem->message();
  }
  EXPECT_EQ(problemOf("scene"), "not judged") << "none is asked for";
}

TEST_F(RequestedPartsTest, ARecordingThatIsNotThere) {
  request_.set.push_back("camera.source=" + path("none.mp4").string());
  EXPECT_THAT(problemOf("camera"), HasSubstr("none.mp4: is neither a camera nor a file"));
}

TEST_F(RequestedPartsTest, ADeviceThatIsNotThere) {
  request_.set.emplace_back("camera.source=serial:none such");
  EXPECT_THAT(problemOf("camera"), HasSubstr("pleinair devices"));
  const auto camera = requestedParts(resolved()).front();
  EXPECT_TRUE(camera.isDevice);
  EXPECT_TRUE(camera.isChosen);
  request_.set.emplace_back("camera.wait=true");
  EXPECT_FALSE(requestedParts(resolved()).front().isChosen) << "it may come";
}

TEST_F(RequestedPartsTest, AFolderOfAnOutputThatIsNotThereWithTheCommandThatMakesIt) {
  request_.set.push_back("output.targets=" + path("none/out.mp4").string());
  EXPECT_THAT(problemOf("output"), HasSubstr("mkdir -p '" + path("none").string() + "'"));
  EXPECT_TRUE(checkOutputFolder(path("frames/").string()));
  EXPECT_TRUE(checkOutputFolder("window"));
  EXPECT_TRUE(checkOutputFolder("loopback:/dev/video50"));
  EXPECT_FALSE(checkOutputFolder(path("none/%04d.png").string()));
}

TEST_F(RequestedPartsTest, ALoopbackIsJudgedAsItsStartFindsIt) {
  const std::filesystem::path link = path("by-path-link");
  std::filesystem::create_symlink("/dev/null", link);
  for (const std::string& node :
       {std::string("/dev/null"), std::string("/dev/none"), link.string()}) {
    const std::string target = "loopback:" + node;
    const auto started = hal::orThrow(hal::openOutput(target))->start({.size = {64, 48}});
    ASSERT_FALSE(started) << target;
    request_.set.push_back("output.targets=" + target);
    EXPECT_EQ(problemOf("output"), started.error().message());
  }
}

TEST_F(RequestedPartsTest, ASceneAndItsCalibration) {
  request_.set.push_back("painting.scene=" + path("none.toml").string());
  EXPECT_THAT(problemOf("scene"), HasSubstr("none.toml"));
  request_.set.push_back("painting.scene=" +
                         write("scene.toml", "[camera]\ncalibration = \"lens.toml\"\n").string());
  EXPECT_THAT(problemOf("scene"), HasSubstr("lens.toml"));
}

TEST_F(RequestedPartsTest, ABrushFile) {
  request_.set.emplace_back("painting.style=painterly");
  EXPECT_EQ(problemOf("style"), "");
  request_.set.push_back("brush_file=" + path("none.png").string());
  EXPECT_THAT(problemOf("style"), HasSubstr("none.png"));
}

}  // namespace
}  // namespace pleinair::app
