// Looks of one's own, in files.
#include "firmware_app/config/look_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "firmware_app/cli/shell_text.h"
#include "pipeline/styles/registry.h"
#include "tests/unit/firmware_app/configuration_test.h"

namespace pleinair::app {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

class LookFileTest : public ConfigurationTest {
 protected:
  void give(const std::string& text) {
    request_.options.push_back({"painting.look", write("mine.toml", text).string(), "--look"});
  }
  std::string mine() const { return path("mine.toml").string(); }
};

TEST_F(LookFileTest, ReplacesDefaultsAndChoosesItsStyle) {
  give("[painting]\nstyle = \"painterly\"\nlook = \"pastel\"\n[style.painterly]\nlayers = 2\n");
  const Configuration configuration = resolved();
  EXPECT_EQ(configuration.painting().style, "painterly");
  const auto pastel = styles::styleKind("painterly").parametersOf("pastel");
  EXPECT_EQ(configuration.styleParameters(), pastel.with("layers", "2"));
  EXPECT_EQ(configuration.origin("style.painterly.layers"), mine() + ":5");
  EXPECT_THAT(configuration.files(), testing::Contains(path("mine.toml")));
}

TEST_F(LookFileTest, IsWeakerThanWhatAnyLayerGives) {
  request_.siteFile = write("s.toml", "[style.watercolor]\ncell_size = 20\n");
  give("[painting]\nstyle = \"watercolor\"\n[style.watercolor]\ncell_size = 12\nreturn_time = 3\n");
  EXPECT_EQ(resolved().styleParameters().text("cell_size"), "20");
  EXPECT_EQ(resolved().styleParameters().text("return_time"), "3");
}

TEST_F(LookFileTest, OfASiteFileStandsBesideIt) {
  write("mine.toml", "[painting]\nstyle = \"hatching\"\n");
  request_.siteFile = write("s.toml", "[painting]\nlook = \"mine.toml\"\n");
  EXPECT_EQ(resolved().painting().style, "hatching");
  request_.options = {{"painting.style", "painterly", "--style"}};
  EXPECT_EQ(resolved().painting().look, "default") << "of the former style";
}

TEST_F(LookFileTest, LetsSetReachItsStyle) {
  give("[painting]\nstyle = \"painterly\"\n");
  request_.set = {"layers=3"};
  EXPECT_EQ(resolved().styleParameters().text("layers"), "3");
}

TEST_F(LookFileTest, IsRefusedBesideAnotherStyle) {
  request_.options = {{"painting.style", "watercolor", "--style"}};
  give("[painting]\nstyle = \"painterly\"\n");
  EXPECT_EQ(refusal(), "--look: " + mine() +
                           " is a look of the style painterly, allowed: a look of watercolor, or "
                           "no other style");
}

TEST_F(LookFileTest, SaysWhatIsWrongInIt) {
  give("[painting]\nstyle = \"painterly\"\n[style.painterly]\nlayerz = 2\n");
  EXPECT_THAT(refusal(), StartsWith(mine() + ":4: style.painterly.layerz: unknown key"));
  give("[painting]\nstyle = \"oils\"\n");
  EXPECT_THAT(refusal(), StartsWith(mine() + ":2: painting.style: found \"oils\""));
  give("[painting]\nstyle = \"painterly\"\n[camera]\nrate = 3\n");
  EXPECT_THAT(refusal(), StartsWith(mine() + ":3: camera: unknown key"));
  give("[style.watercolor]\ncell_size = 9\n");
  EXPECT_THAT(refusal(), HasSubstr("painting"));
  request_.options = {{"painting.look", path("absent.toml").string(), "--look"}};
  EXPECT_THAT(refusal(), StartsWith("--look: " + path("absent.toml").string()));
}

TEST_F(LookFileTest, IsReadBackAsItWasWritten) {
  const auto values =
      styles::styleKind("watercolor").parametersOf("glazed").with("cell_size", "11");
  give(lookFileText("watercolor", values));
  EXPECT_EQ(resolved().styleParameters(), values);
  request_.options.clear();
  request_.siteFile = path("mine.toml");
  EXPECT_EQ(resolved().styleParameters(), values) << "as a site file";
}

TEST(ShellText, QuotesWhatAShellWouldRead) {
  const std::vector<std::string> words{"pleinair", "--set", "a=1", "my film.mp4", "it's", "", "$x"};
  EXPECT_EQ(shellText(words), "pleinair --set a=1 'my film.mp4' 'it'\\''s' '' '$x'");
}

}  // namespace
}  // namespace pleinair::app
