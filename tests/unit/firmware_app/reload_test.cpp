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

}  // namespace
}  // namespace pleinair::app
