#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "config/config_error.h"
#include "firmware_app/config/configuration.h"
#include "tests/support/temporary_folder.h"

namespace pleinair::app {
namespace {

TEST(OutputTargets, OfASiteFileAreNamesOrPathsFromIt) {
  const support::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "site.toml";
  const auto targetOf = [&](const std::string& name) {
    std::ofstream(file) << "[output]\ntarget = \"" << name << "\"\nsecond_target = \"" << name
                        << "\"\n";
    const OutputSettings output = Configuration({.siteFile = file}).output();
    EXPECT_EQ(output.target, output.secondTarget);
    return output.target;
  };
  for (const std::string name :
       {"window", "loopback", "loopback:/dev/video50", "loopback:the hall"}) {
    EXPECT_EQ(targetOf(name), name);
  }
  EXPECT_EQ(targetOf("a.mp4"), folder.path() / "a.mp4");
  EXPECT_THROW(targetOf("loopback:"), config::ConfigError);
}

}  // namespace
}  // namespace pleinair::app
