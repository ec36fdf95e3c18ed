#include "firmware_app/doctor/probes.h"

#include <cerrno>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include "tests/support/temporary_folder.h"

namespace pleinair::app::doctor {
namespace {

TEST(SystemProbes, LookAtTheMachine) {
  const support::TemporaryFolder folder;
  std::ofstream(folder.path() / "b") << "two words \n\n";
  std::ofstream(folder.path() / "a").flush();
  const Probes probes = systemProbes();
  EXPECT_EQ(probes.read(folder.path() / "b"), "two words");
  EXPECT_EQ(probes.read(folder.path() / "c"), std::nullopt);
  EXPECT_THAT(probes.list(folder.path()),
              testing::ElementsAre(folder.path() / "a", folder.path() / "b"));
  EXPECT_THAT(probes.list(folder.path() / "none"), testing::IsEmpty());
  EXPECT_EQ(probes.access(folder.path()), 0);
  EXPECT_EQ(probes.access(folder.path() / "c"), ENOENT);
  EXPECT_GT(probes.freeBytes(folder.path()).value_or(0), 0u);
  EXPECT_EQ(probes.freeBytes(folder.path() / "none"), std::nullopt);
  rlimit files{};
  getrlimit(RLIMIT_NOFILE, &files);
  EXPECT_EQ(probes.limit(RLIMIT_NOFILE), files.rlim_cur);
}

}  // namespace
}  // namespace pleinair::app::doctor
