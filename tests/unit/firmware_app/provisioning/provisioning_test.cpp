// What is in force of what was found, and what is said of it.
#include "firmware_app/provisioning/provisioning.h"

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "firmware_app/config/configuration.h"
#include "firmware_app/config/configured_parts.h"
#include "tests/support/environment.h"
#include "tests/unit/firmware_app/provisioning/medium.h"

namespace pleinair::app {
namespace {

using namespace std::chrono_literals;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;
using testing::StartsWith;

class ProvisioningTest : public testing::Test {
 protected:
  ProvisioningPlaces places() const {
    return {.folders = {credentials_.path(), stick_.path()}, .state = state_.path()};
  }
  /// As `pleinair run` checks it, as far as no device is needed.
  static void check(const std::filesystem::path& siteFile, const std::optional<std::string>& text) {
    ConfigurationRequest request;
    request.siteFile = siteFile;
    request.siteText = text;
    const Configuration configuration(request);
    configuration.attributing([&] { configuredScene(configuration); });
  }
  Provisioned start() const { return provision(places(), check); }
  /// The value of a key of what is in force.
  static std::string styleOf(const Provisioned& provisioned) {
    ConfigurationRequest request;
    request.siteFile = provisioned.siteFile.value();
    return Configuration(request).painting().style;
  }

  Medium stick_;
  Medium credentials_;
  Medium state_;
};

TEST_F(ProvisioningTest, AGoodOneIsTakenAndKept) {
  stick_.write("site.toml", "[painting]\nstyle = \"painterly\"\n");
  const Provisioned first = start();
  EXPECT_THAT(first.problems, IsEmpty());
  ASSERT_TRUE(first.siteFile);
  EXPECT_EQ(styleOf(first), "painterly");
  EXPECT_EQ(first.origin, stick_.path().string());
  EXPECT_THAT(first.siteFile->string(), StartsWith(state_.path().string()));
  EXPECT_EQ(provisioningText(first, false), "");
  stick_.clear();  // it is pulled
  const Provisioned second = start();
  EXPECT_EQ(second.siteFile, first.siteFile);
  EXPECT_EQ(second.origin, state_.path().string());
  EXPECT_EQ(provisioningText(second, false), "");
  EXPECT_EQ(keptSiteFile(state_.path()), first.siteFile);
}

TEST_F(ProvisioningTest, AnotherOneReplacesIt) {
  stick_.write("site.toml", "[painting]\nstyle = \"painterly\"\n");
  start();
  stick_.write("site.toml", "[painting]\nstyle = \"hatching\"\n");
  EXPECT_EQ(styleOf(start()), "hatching");
}

TEST_F(ProvisioningTest, WithoutAnyTheScreenSaysHow) {
  const Provisioned none = start();
  EXPECT_FALSE(none.siteFile);
  EXPECT_THAT(none.problems, IsEmpty());
  EXPECT_THAT(provisioningText(none, false),
              AllOf(HasSubstr("Not set up yet"), HasSubstr("PLEINAIR"), HasSubstr("site.toml")));
  EXPECT_EQ(provisioningText(none, true), "") << "somebody has set it up with a shell";
  stick_.write("site.toml", "");
  EXPECT_EQ(provisioningText(start(), false), "") << "an empty file is enough";
}

TEST_F(ProvisioningTest, CredentialsAreStrongerThanAMedium) {
  stick_.write("site.toml", "[painting]\nstyle = \"painterly\"\n");
  credentials_.write("site.toml", "[painting]\nstyle = \"hatching\"\n");
  EXPECT_EQ(styleOf(start()), "hatching");
  EXPECT_EQ(start().origin, credentials_.path().string());
}

TEST_F(ProvisioningTest, CredentialsAreWhereTheServiceManagerSays) {
  const std::optional<std::filesystem::path> folder = stick_.path();
  credentials_.write("other", "");
  support::setVariable("CREDENTIALS_DIRECTORY", credentials_.path().c_str());
  EXPECT_THAT(ProvisioningPlaces::of(folder, {}).folders, ElementsAre(stick_.path()));
  credentials_.write("site.toml", "");
  EXPECT_THAT(ProvisioningPlaces::of(folder, {}).folders,
              ElementsAre(credentials_.path(), stick_.path()));
  EXPECT_THAT(ProvisioningPlaces::of({}, {}).folders, ElementsAre(credentials_.path()));
  support::setVariable("CREDENTIALS_DIRECTORY", nullptr);
  EXPECT_THAT(ProvisioningPlaces::of({}, {}).folders, IsEmpty());
}

TEST_F(ProvisioningTest, EveryErrorIsToldWithFileLineAndRemedy) {
  stick_.write("site.toml",
               "[painting]\n"
               "stlye = \"painterly\"\n"
               "view = 7\n"
               "[runtime]\n"
               "latency = 120\n"
               "quality = \"best\"\n"
               "[paintng]\n"
               "style = \"oils\"\n"
               "[output.display]\n"
               "rotation = \"45\"\n");
  const Provisioned broken = start();
  EXPECT_FALSE(broken.siteFile);
  EXPECT_EQ(broken.origin, "") << "nothing of it is in force";
  EXPECT_EQ(broken.found, stick_.path().string());
  EXPECT_THAT(
      broken.problems,
      ElementsAre(
          AllOf(StartsWith("site.toml:2: painting.stlye: unknown key"), HasSubstr("style")),
          AllOf(StartsWith("site.toml:3: painting.view: "), HasSubstr("allowed")),
          AllOf(StartsWith("site.toml:6: runtime.quality: found \"best\""), HasSubstr("auto")),
          AllOf(StartsWith("site.toml:7: paintng: unknown key"), HasSubstr("painting")),
          AllOf(StartsWith("site.toml:10: output.display.rotation: "), HasSubstr("90"))));
  const std::string text = provisioningText(broken, false);
  EXPECT_THAT(text, HasSubstr("there is none before it"));
  for (const std::string& each : broken.problems) EXPECT_THAT(text, HasSubstr(each));
}

TEST_F(ProvisioningTest, AnErrorOfSyntaxIsOne) {
  stick_.write("site.toml", "[painting]\nstyle = painterly\nlook = \"x\n");
  EXPECT_THAT(start().problems, ElementsAre(StartsWith("site.toml:2: not TOML")));
}

TEST_F(ProvisioningTest, AfterABrokenOneTheLastGoodOneStaysInForce) {
  stick_.write("site.toml", "[painting]\nstyle = \"painterly\"\n");
  const Provisioned good = start();
  stick_.write("site.toml", "[painting]\nstyle = \"oils\"\n");
  for (int starts = 0; starts < 2; ++starts) {
    const Provisioned broken = start();
    EXPECT_EQ(broken.siteFile, good.siteFile);
    EXPECT_EQ(styleOf(broken), "painterly");
    EXPECT_THAT(broken.problems, ElementsAre(StartsWith("site.toml:2: painting.style: ")));
    EXPECT_THAT(provisioningText(broken, false), HasSubstr("the one before it still is"));
  }
  stick_.write("site.toml", "[painting]\nstyle = \"hatching\"\n");
  const Provisioned mended = start();
  EXPECT_EQ(styleOf(mended), "hatching");
  EXPECT_EQ(provisioningText(mended, false), "");
}

TEST_F(ProvisioningTest, ASceneComesWithIt) {
  stick_.write("site.toml", "[painting]\nscene = \"scenes/bench.toml\"\n");
  EXPECT_THAT(start().problems, ElementsAre(AllOf(StartsWith("site.toml:2: painting.scene: "),
                                                  HasSubstr("scenes/bench.toml"),
                                                  Not(HasSubstr(state_.path().string())))));
  stick_.write("scenes/bench.toml", "[[tag]]\nid = 3\nedge_m = \"big\"\n");
  EXPECT_THAT(start().problems, ElementsAre(StartsWith("scenes/bench.toml:3: tag[0].edge_m: ")));
  stick_.write("scenes/bench.toml", "[[tag]]\nid = 3\nedge_m = 0.08\n");
  const Provisioned good = start();
  EXPECT_THAT(good.problems, IsEmpty());
  ASSERT_TRUE(good.siteFile);
  stick_.clear();
  EXPECT_NO_THROW(check(*start().siteFile, {})) << "the scene is kept, too";
}

TEST_F(ProvisioningTest, WhatIsNoSiteFileIsToldAndNothingElseIsRead) {
  stick_.write("site.toml", "[painting]\nstyle = \"painterly\"\n");
  const Provisioned good = start();
  const Medium outside;
  outside.write("scene.toml", "[[tag]]\nid = 3\nedge_m = 0.08\n");
  const auto expectRefusal = [&](const std::string& problem) {
    const Provisioned broken = start();
    EXPECT_EQ(broken.siteFile, good.siteFile);
    EXPECT_THAT(broken.problems, ElementsAre(HasSubstr(problem)));
    stick_.clear();
  };
  stick_.clear();
  stick_.link("site.toml", outside.path() / "scene.toml");
  expectRefusal("site.toml: is a symbolic link");
  stick_.write("site.toml", "[painting]\nscene = \"scene.toml\"\n");
  stick_.link("scene.toml", outside.path() / "scene.toml");
  expectRefusal("scene.toml: is a symbolic link");
  stick_.write("site.toml", "# \xE9\n");
  expectRefusal("not encoded in UTF-8");
  stick_.write("site.toml", std::string((1U << 20U) + 1, '#'));
  expectRefusal("site.toml: too large");
  stick_.write("site.toml", "");
  stick_.write("film.mp4", std::string(33U << 20U, 'x'));
  expectRefusal("is too large");
}

TEST_F(ProvisioningTest, WhereItCannotBeKeptTheOneBeforeStaysAndThatIsSaid) {
  stick_.write("site.toml", "");
  ProvisioningPlaces nowhere = places();
  nowhere.state.clear();
  const Provisioned provisioned = provision(nowhere, check);
  EXPECT_FALSE(provisioned.siteFile);
  EXPECT_THAT(provisioned.problems, ElementsAre(HasSubstr("cannot be kept")));
}

TEST_F(ProvisioningTest, WhatAnotherVersionOfTheProgramRefusesIsNotInForce) {
  stick_.write("site.toml", "[painting]\nstyle = \"painterly\"\n");
  start();
  stick_.clear();
  const Provisioned refused = provision(places(), [](const auto& siteFile, const auto&) {
    throw config::ConfigError(
        {.file = siteFile.string(), .line = 2, .key = "painting.style", .problem = "is gone"});
  });
  EXPECT_FALSE(refused.siteFile);
  EXPECT_THAT(refused.problems, SizeIs(testing::Ge(1)));
  EXPECT_EQ(refused.problems.front(), "site.toml:2: painting.style: is gone");
  EXPECT_TRUE(start().siteFile) << "the old version may come back";
}

class SiteWatchTest : public ProvisioningTest {
 protected:
  static bool comesToSee(const SiteWatch& watch) {
    const auto deadline = std::chrono::steady_clock::now() + 20s;
    while (std::chrono::steady_clock::now() < deadline) {
      if (watch.hasChanged()) return true;
      std::this_thread::yield();
    }
    return false;
  }
  /// Over some more looks.
  static void expectNothingNew(const SiteWatch& watch) {
    const auto deadline = std::chrono::steady_clock::now() + 20s;
    const std::uint64_t enough = watch.looks() + 4;
    while (watch.looks() < enough && std::chrono::steady_clock::now() < deadline) {
      ASSERT_FALSE(watch.hasChanged());
      std::this_thread::yield();
    }
    EXPECT_GE(watch.looks(), enough);
    EXPECT_FALSE(watch.hasChanged());
  }
};

TEST_F(SiteWatchTest, SeesAMediumThatComesAndOneThatWasWritten) {
  {
    const SiteWatch watch(places(), 1ms);
    EXPECT_FALSE(watch.hasChanged());
    stick_.write("site.toml", "");
    EXPECT_TRUE(comesToSee(watch));
  }
  const SiteWatch watch(places(), 1ms);
  EXPECT_FALSE(watch.hasChanged()) << "it is the one that was there at the start";
  stick_.write("site.toml", "[painting]\n");
  EXPECT_TRUE(comesToSee(watch));
}

TEST_F(SiteWatchTest, SeesAMediumAgainThatWasPulledWhileItWasRead) {
  stick_.write("site.toml", "");
  const SiteWatch watch(places(), 1ms);
  const auto away = stick_.path().string() + ".away";
  std::filesystem::rename(stick_.path(), away);
  expectNothingNew(watch);
  EXPECT_FALSE(watch.hasChanged(true)) << "while it is away";
  std::filesystem::rename(away, stick_.path());
  expectNothingNew(watch);
  EXPECT_TRUE(watch.hasChanged(true));
}

TEST_F(SiteWatchTest, IsNotImpressedByAMediumThatGoesAndComesBack) {
  stick_.write("site.toml", "");
  const SiteWatch watch(places(), 1ms);
  const auto away = stick_.path().string() + ".away";
  std::filesystem::rename(stick_.path(), away);
  expectNothingNew(watch);
  std::filesystem::rename(away, stick_.path());
  expectNothingNew(watch);
}

}  // namespace
}  // namespace pleinair::app
