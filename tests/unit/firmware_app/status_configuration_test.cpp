#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "config/config_error.h"
#include "firmware_app/config/configured_parts.h"
#include "tests/support/temporary_folder.h"

namespace pleinair::app {
namespace {

using testing::HasSubstr;

class StatusConfiguration : public testing::Test {
 protected:
  Configuration of(const std::string& toml) {
    const std::filesystem::path file = folder_.path() / "site.toml";
    std::ofstream(file) << toml;
    return Configuration({.siteFile = file});
  }

  support::TemporaryFolder folder_;
};

TEST_F(StatusConfiguration, IsOffUnlessTold) {
  EXPECT_EQ(configuredStatusServer(of(""), {}), nullptr);
}

TEST_F(StatusConfiguration, AttributesThePlaceOfAnAddressThatIsNone) {
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
