// Folders that anybody may have written.
#include "firmware_app/provisioning/bundle.h"

#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tests/unit/firmware_app/provisioning/medium.h"

namespace pleinair::app {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::Key;
using testing::UnorderedElementsAre;

class BundleTest : public testing::Test {
 protected:
  std::string refusal(const BundleLimits& limits = {}) const {
    const auto bundle = readBundle(medium_.path(), limits);
    if (!bundle) return bundle.error().message();
    ADD_FAILURE() << "it was read";
    return {};
  }

  Medium medium_;
};

TEST_F(BundleTest, HoldsTheSiteFileAndWhatLiesBesideIt) {
  medium_.write("site.toml", "[painting]\n");
  medium_.write("scene.toml", "x");
  medium_.write("models/cup.gltf", std::string("\0\xFF", 2));
  EXPECT_TRUE(hasSite(medium_.path()));
  const auto bundle = readBundle(medium_.path());
  ASSERT_TRUE(bundle) << bundle.error().message();
  EXPECT_THAT(bundle->files,
              UnorderedElementsAre(Key("site.toml"), Key("scene.toml"), Key("models/cup.gltf")));
  EXPECT_EQ(bundle->files.at("models/cup.gltf"), std::string("\0\xFF", 2));
}

TEST_F(BundleTest, WithoutASiteFileIsNone) {
  EXPECT_FALSE(hasSite(medium_.path()));
  EXPECT_FALSE(hasSite(medium_.path() / "nowhere"));
  medium_.write("holiday.jpg", "x");
  EXPECT_FALSE(hasSite(medium_.path()));
  EXPECT_EQ(fingerprintOf(medium_.path()), "");
}

TEST_F(BundleTest, LeavesOutWhatSystemsPutOnMedia) {
  medium_.write("site.toml", "");
  medium_.write(".Trash-1000/site.toml", "old");
  medium_.write("._site.toml", "mac");
  medium_.write("System Volume Information/IndexerVolumeGuid", "x");
  medium_.write("$RECYCLE.BIN/desktop.ini", "x");
  const auto bundle = readBundle(medium_.path());
  ASSERT_TRUE(bundle);
  EXPECT_EQ(bundle->files.size(), 1u);
}

TEST_F(BundleTest, OfAFileSystemWithoutCase) {
  medium_.write("SITE.TOML", "[painting]\n");
  EXPECT_TRUE(hasSite(medium_.path()));
  const auto bundle = readBundle(medium_.path());
  ASSERT_TRUE(bundle);
  EXPECT_TRUE(bundle->files.contains("site.toml"));
}

TEST_F(BundleTest, SaysWhatWindowsHides) {
  medium_.write("site.toml.txt", "");
  EXPECT_TRUE(hasSite(medium_.path()));
  EXPECT_THAT(refusal(), AllOf(HasSubstr("site.toml.txt: has a second ending"),
                               HasSubstr("rename it site.toml")));
}

TEST_F(BundleTest, FollowsNoLink) {
  const Medium outside;
  outside.write("secret", "s3cret");
  medium_.write("site.toml", "");
  medium_.link("scene.toml", outside.path() / "secret");
  EXPECT_THAT(refusal(), AllOf(HasSubstr("scene.toml: is a symbolic link"),
                               HasSubstr("put the file itself in its place")));
  medium_.clear();
  medium_.link("site.toml", outside.path() / "secret");
  EXPECT_TRUE(hasSite(medium_.path()));
  EXPECT_THAT(refusal(), HasSubstr("site.toml: is a symbolic link"));
  medium_.clear();
  medium_.write("site.toml", "");
  medium_.link("models", outside.path());
  EXPECT_THAT(refusal(), HasSubstr("models: is a symbolic link"));
}

TEST_F(BundleTest, OpensNoDeviceAndNoPipe) {
  medium_.write("site.toml", "");
  ASSERT_EQ(::mkfifo((medium_.path() / "pipe").c_str(), 0600), 0);
  EXPECT_THAT(refusal(), HasSubstr("pipe: is no ordinary file"));
  fs::remove(medium_.path() / "pipe");
  fs::remove(medium_.path() / "site.toml");
  fs::create_directory(medium_.path() / "site.toml");
  EXPECT_THAT(refusal(), HasSubstr("site.toml: is not there"));
}

TEST_F(BundleTest, HasLimits) {
  medium_.write("site.toml", "");
  medium_.write("a.bin", std::string(600, 'x'));
  EXPECT_TRUE(readBundle(medium_.path(), {.files = 2, .bytes = 600}));
  EXPECT_THAT(refusal({.files = 1, .bytes = 600}), HasSubstr("is more than 1 files"));
  EXPECT_THAT(refusal({.files = 2, .bytes = 599}),
              AllOf(HasSubstr("a.bin: is too large"), HasSubstr("keep only site.toml")));
  medium_.write("1/2/3/deep.bin", "");
  EXPECT_TRUE(readBundle(medium_.path()));
  EXPECT_THAT(refusal({.depth = 2}), HasSubstr("lies too deep"));
}

TEST_F(BundleTest, RefusesEncodingsThatEditorsChoose) {
  medium_.write("site.toml", std::string("\xFF\xFE[\0p\0]\0", 8));
  EXPECT_THAT(refusal(), AllOf(HasSubstr("UTF-16"), HasSubstr("save it as UTF-8")));
  medium_.write("site.toml", "# M\xFCnchen\n");
  EXPECT_THAT(refusal(),
              AllOf(HasSubstr("is not encoded in UTF-8"), HasSubstr("save it as UTF-8")));
  medium_.write("site.toml", "# M\xC3\xBCnchen\r\n");
  EXPECT_TRUE(readBundle(medium_.path())) << "a control";
}

TEST_F(BundleTest, SaysWhatMayNotBeRead) {
  if (::geteuid() != 0) GTEST_SKIP() << "only root can become somebody else";
  medium_.write("site.toml", "");
  medium_.write("scene.toml", "");
  fs::permissions(medium_.path(), fs::perms(0755));
  fs::permissions(medium_.path() / "scene.toml", fs::perms::none);
  constexpr uid_t kNobody = 65534;
  ASSERT_EQ(::seteuid(kNobody), 0);
  const auto bundle = readBundle(medium_.path());
  ASSERT_EQ(::seteuid(0), 0);
  ASSERT_FALSE(bundle);
  EXPECT_EQ(bundle.error().kind, hal::ErrorKind::kPermissionDenied);
  EXPECT_THAT(bundle.error().message(), HasSubstr("scene.toml: cannot be opened"));
}

TEST_F(BundleTest, DigestsTellPathsAndContents) {
  const std::string digest = digestOf({{{"site.toml", "ab"}, {"x", "c"}}});
  EXPECT_EQ(digest.size(), 64u);
  EXPECT_EQ(digest, digestOf({{{"x", "c"}, {"site.toml", "ab"}}}));
  EXPECT_NE(digest, digestOf({{{"site.toml", "a"}, {"x", "bc"}}}));
  EXPECT_NE(digest, digestOf({{{"site.toml", "ab"}, {"y", "c"}}}));
  EXPECT_NE(digest, digestOf({{{"site.toml", "ab"}}}));
}

TEST_F(BundleTest, FingerprintsTellThatSomethingWasWritten) {
  medium_.write("site.toml", "[painting]\n");
  const std::string before = fingerprintOf(medium_.path());
  EXPECT_NE(before, "");
  EXPECT_EQ(fingerprintOf(medium_.path()), before);
  medium_.write("site.toml", "[painting]\n\n");
  const std::string after = fingerprintOf(medium_.path());
  EXPECT_NE(after, before);
  medium_.write("scene.toml", "");
  EXPECT_NE(fingerprintOf(medium_.path()), after);
}

}  // namespace
}  // namespace pleinair::app
