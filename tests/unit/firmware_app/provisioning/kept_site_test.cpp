// The copy in the state folder, over power cuts.
#include "firmware_app/provisioning/kept_site.h"

#include <algorithm>
#include <array>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/unit/firmware_app/provisioning/medium.h"

namespace pleinair::app {
namespace {

namespace fs = std::filesystem;

Bundle bundleOf(const std::string& text) {
  return {{{"site.toml", text}, {"models/cup.gltf", "cup"}}};
}

std::string contentOf(const fs::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

class KeptSiteTest : public testing::Test {
 protected:
  KeptSite::Copy keep(const std::string& text) const {
    const auto copy = hal::orThrow(kept_.write(bundleOf(text)));
    hal::orThrow(kept_.putInForce(copy));
    return copy;
  }
  std::ptrdiff_t copies() const {
    const fs::directory_iterator first(state_.path());
    return std::count_if(first, fs::directory_iterator(),
                         [](const auto& each) { return each.is_directory(); });
  }

  Medium state_;
  KeptSite kept_{state_.path()};
};

TEST_F(KeptSiteTest, IsInForceOnceItIsPutThere) {
  EXPECT_FALSE(kept_.inForce());
  const auto copy = hal::orThrow(kept_.write(bundleOf("one")));
  EXPECT_FALSE(kept_.inForce()) << "the power may go here";
  hal::orThrow(kept_.putInForce(copy));
  ASSERT_TRUE(kept_.inForce());
  EXPECT_EQ(kept_.inForce()->digest, digestOf(bundleOf("one")));
  EXPECT_EQ(contentOf(kept_.inForce()->siteFile()), "one");
  EXPECT_EQ(contentOf(kept_.inForce()->folder / "models/cup.gltf"), "cup");
  EXPECT_EQ(KeptSite(state_.path()).inForce()->digest, copy.digest) << "in the next run";
}

TEST_F(KeptSiteTest, TheNextOneReplacesItAtOnce) {
  const auto first = keep("one");
  const auto second = hal::orThrow(kept_.write(bundleOf("two")));
  EXPECT_EQ(kept_.inForce()->digest, first.digest) << "the power may go here";
  hal::orThrow(kept_.putInForce(second));
  EXPECT_EQ(kept_.inForce()->digest, second.digest);
  EXPECT_EQ(copies(), 1) << "nothing is left of the first";
}

TEST_F(KeptSiteTest, PartsOfARunThatWasCutOffAreReplaced) {
  const std::string digest = digestOf(bundleOf("one"));
  state_.write(fs::path("provisioned." + digest.substr(0, 16)) / "models/old.gltf", "part");
  keep("one");
  ASSERT_TRUE(kept_.inForce());
  EXPECT_FALSE(fs::exists(kept_.inForce()->folder / "models/old.gltf"));
}

TEST_F(KeptSiteTest, ADamagedOneIsNone) {
  const auto copy = keep("one");
  std::ofstream(copy.folder / "models/cup.gltf") << "cap";
  EXPECT_FALSE(kept_.inForce());
  keep("one");
  EXPECT_TRUE(kept_.inForce()) << "written anew";
  fs::remove(copy.folder / "site.toml");
  EXPECT_FALSE(kept_.inForce());
}

TEST_F(KeptSiteTest, ADamagedPointerPointsNowhere) {
  keep("one");
  for (const char* text : {"", "../../etc", "0123", "g\n"}) {
    state_.write("provisioned", text);
    EXPECT_FALSE(kept_.inForce()) << text;
  }
  state_.write("provisioned", std::string(64, '/'));
  EXPECT_FALSE(kept_.inForce());
}

TEST_F(KeptSiteTest, KilledAtAnyMomentOneOfBothIsInForce) {
  keep("one");
  std::mt19937 random(7);
  std::uniform_int_distribution<int> puts(0, 3);
  int changes = 0;
  std::string last = kept_.inForce()->digest;
  for (int kill = 0; kill < 40; ++kill) {
    std::array<int, 2> pipe{};
    ASSERT_EQ(::pipe(pipe.data()), 0);
    const pid_t child = ::fork();
    if (child == 0) {
      for (int i = 0;; ++i) {
        if (::write(pipe[1], "x", 1) != 1) ::_exit(1);
        const auto copy = kept_.write(bundleOf(i % 2 == 0 ? "two" : "one"));
        if (!copy || !kept_.putInForce(*copy)) ::_exit(1);
      }
    }
    // It is somewhere in the next one then, each time elsewhere.
    char progress = 0;
    for (int i = puts(random); i >= 0; --i) ASSERT_EQ(::read(pipe[0], &progress, 1), 1);
    ::kill(child, SIGKILL);
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFSIGNALED(status)) << "it could not write";
    ::close(pipe[0]);
    ::close(pipe[1]);
    const auto now = kept_.inForce();
    ASSERT_TRUE(now) << "kill " << kill;
    EXPECT_THAT(now->digest, testing::AnyOf(digestOf(bundleOf("one")), digestOf(bundleOf("two"))));
    changes += now->digest != last ? 1 : 0;
    last = now->digest;
  }
  EXPECT_GT(changes, 3) << "a control: it was in the midst of it";
}

TEST_F(KeptSiteTest, WhereNothingCanBeWrittenTheOneBeforeStays) {
  const auto copy = keep("one");
  state_.write("blocked", "a file");
  const KeptSite nowhere(state_.path() / "blocked");
  EXPECT_FALSE(nowhere.write(bundleOf("two")));
  EXPECT_FALSE(KeptSite({}).write(bundleOf("two")));
  EXPECT_EQ(kept_.inForce()->digest, copy.digest);
}

}  // namespace
}  // namespace pleinair::app
