#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "config/config_error.h"
#include "firmware_app/configured_parts.h"
#include "tests/support/temporary_folder.h"

namespace pleinair::app {
namespace {

using testing::HasSubstr;

class OutputConfiguration : public testing::Test {
 protected:
  Configuration of(const std::string& toml) {
    const std::filesystem::path file = folder_.path() / "site.toml";
    std::ofstream(file) << toml;
    return Configuration({.siteFile = file});
  }

  support::TemporaryFolder folder_;
};

TEST_F(OutputConfiguration, ALoopbackIsNoPath) {
  for (const std::string name : {"loopback", "loopback:/dev/video50", "loopback:the hall"}) {
    EXPECT_EQ(of("[output]\ntarget = \"" + name + "\"").output().target, name);
  }
  EXPECT_EQ(of("[output]\ntarget = \"a.mp4\"").output().target, folder_.path() / "a.mp4");
  EXPECT_THROW(of("[output]\ntarget = \"loopback:\""), config::ConfigError);
}

TEST_F(OutputConfiguration, NamesTheLayoutOfALoopback) {
  EXPECT_EQ(of("").output().loopbackFormat, std::nullopt);
  EXPECT_EQ(of("[output]\nloopback_format = \"nv12\"").output().loopbackFormat,
            hal::PixelFormat::kNv12);
  EXPECT_THROW(of("[output]\nloopback_format = \"rgb8\""), config::ConfigError);
}

TEST_F(OutputConfiguration, StatusIsOffUnlessTold) {
  EXPECT_EQ(configuredStatusServer(of(""), {}), nullptr);
}

TEST_F(OutputConfiguration, BlamesThePlaceOfAnAddressThatIsNone) {
  try {
    configuredStatusServer(of("[status]\nlisten = \"9117\""), {});
    ADD_FAILURE();
  } catch (const config::ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("site.toml:2"));
    EXPECT_THAT(error.what(), HasSubstr("found \"9117\", allowed: off, or ADDRESS:PORT"));
  }
}

}  // namespace
}  // namespace pleinair::app
