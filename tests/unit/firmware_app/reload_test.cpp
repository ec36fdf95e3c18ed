#include "firmware_app/config/reload.h"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "config/config_error.h"
#include "firmware_app/config/configured_parts.h"
#include "hal/error.h"
#include "tests/support/temporary_folder.h"

namespace pleinair::app {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

class ReloadTest : public testing::Test {
 protected:
  void write(const std::string& text) { std::ofstream(site_) << text; }
  ConfigurationRequest request() const {
    ConfigurationRequest request;
    request.siteFile = site_;
    return request;
  }
  void start(const std::string& text) {
    write(text);
    started_.emplace(request());
    painting_ = configuredPainting(*started_, {});
  }
  Reload reload(const std::string& text) {
    write(text);
    return reloaded(request(), *started_, painting_);
  }

  support::TemporaryFolder folder_;
  std::filesystem::path site_ = folder_.path() / "site.toml";
  std::optional<Configuration> started_;
  PaintingOptions painting_;
};

TEST_F(ReloadTest, AppliesTheParametersOfTheStyle) {
  start("[style.watercolor]\ncell_size = 12\n");
  EXPECT_EQ(painting_.parameters->text("cell_size"), "12");
  const Reload next = reload("[painting]\nview = \"cells\"\n[style.watercolor]\ncell_size = 20\n");
  EXPECT_EQ(next.painting.parameters->text("cell_size"), "20");
  EXPECT_EQ(next.painting.view, "cells");
  EXPECT_THAT(next.later, IsEmpty());
}

TEST_F(ReloadTest, AppliesAnotherLook) {
  start("");
  const Reload next = reload("[painting]\nlook = \"mosaic\"\n");
  EXPECT_FALSE(*next.painting.parameters == *painting_.parameters);
  EXPECT_THAT(next.later, IsEmpty());
}

TEST_F(ReloadTest, NamesWhatTakesEffectLater) {
  start("");
  const Reload next =
      reload("[camera]\nrate = 15\n[runtime]\nlatency = 200\n[style.watercolor]\ncell_size = 20\n");
  EXPECT_THAT(next.later, ElementsAre("camera.rate", "runtime.latency"));
  EXPECT_EQ(next.painting.parameters->text("cell_size"), "20");
}

TEST_F(ReloadTest, LeavesTheStyleUntilTheNextStart) {
  start("");
  const Reload next = reload("[painting]\nstyle = \"painterly\"\nlook = \"impasto\"\n");
  EXPECT_THAT(next.later, ElementsAre("painting.style"));
  EXPECT_TRUE(*next.painting.parameters == *painting_.parameters);
  EXPECT_EQ(next.painting.style, "watercolor");
}

TEST_F(ReloadTest, RefusesWhatIsWrongWithItsPlace) {
  start("");
  try {
    reload("[style.watercolor]\n\ncell_size = -3\n");
    FAIL() << "taken";
  } catch (const config::ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("site.toml:3"));
  }
  EXPECT_THROW(reload("[painting]\nview = \"nope\"\n"), config::ConfigError);
  EXPECT_THROW(reload("[["), config::ConfigError);
  std::filesystem::remove(site_);
  EXPECT_THROW(reloaded(request(), *started_, painting_), config::ConfigError);
}

TEST_F(ReloadTest, TellsWhatWasReadAndWhatComesLater) {
  start("");
  const ReloadOutcome all = outcomeOf([&] { return reload("[painting]\nview = \"cells\"\n"); });
  ASSERT_TRUE(all.painting);
  EXPECT_EQ(all.painting->view, "cells");
  EXPECT_EQ(all.notice, "the configuration was read again");
  const ReloadOutcome later =
      outcomeOf([&] { return reload("[camera]\nrate = 15\n[runtime]\nlatency = 200\n"); });
  EXPECT_TRUE(later.painting);
  EXPECT_EQ(later.notice,
            "the configuration was read again; at the next start: camera.rate, runtime.latency");
}

TEST_F(ReloadTest, TellsWhyTheLastOneStaysInForce) {
  start("");
  const ReloadOutcome wrong =
      outcomeOf([&] { return reload("[style.watercolor]\ncell_size = -3\n"); });
  EXPECT_FALSE(wrong.painting);
  EXPECT_THAT(wrong.notice, StartsWith("the last configuration stays in force: "));
  EXPECT_THAT(wrong.notice, HasSubstr("site.toml:2"));
  const ReloadOutcome failed = outcomeOf([]() -> Reload {
    throw hal::Failure({.kind = hal::ErrorKind::kIo, .subject = "disk", .problem = "is gone"});
  });
  EXPECT_FALSE(failed.painting);
  EXPECT_THAT(failed.notice, HasSubstr("disk"));
  // The painting could not start with such a view.
  const ReloadOutcome unpaintable = outcomeOf([&] {
    Reload next{.painting = painting_, .later = {}};
    next.painting.view = "nope";
    return next;
  });
  EXPECT_FALSE(unpaintable.painting);
  EXPECT_THAT(unpaintable.notice, HasSubstr("nope"));
}

}  // namespace
}  // namespace pleinair::app
