// Parameters that are texts, paths, sizes, and names known only at run time.
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "config/parameter_table.h"
#include "tests/support/temporary_folder.h"
#include "tests/unit/config/thrown_error.h"

namespace pleinair::config {
namespace {

namespace fs = std::filesystem;

struct Parameters {
  std::string title = "untitled";
  std::string style = "oil";
  fs::path scene = "none";
  fs::path profile = "none";
  PixelSize size;
  PixelSize frame{640, 480};
  bool operator==(const Parameters&) const = default;
};

const ParameterTable<Parameters>& table() {
  using P = Parameters;
  static const SizeRange kSizes{.maxSide = 8192, .maxPixels = 64'000'000};
  static const ParameterTable<P> kTable{
      textParameter("title", &P::title, "a title", "What it is called."),
      choiceParameter("style", &P::style, {"oil", "ink"}, "How to paint."),
      pathParameter("scene", &P::scene, {"none", "synthetic"}, "What is in it."),
      pathParameter("profile", &P::profile, {"none"}, "What it builds on.", TakesEffect::kRestart,
                    ".toml"),
      sizeParameter("size", &P::size, kSizes, {"camera"}, "Of the picture."),
      sizeParameter("frame", &P::frame, kSizes, {}, "Of the frames.")};
  return kTable;
}

Parameters with(const char* name, const std::string& text) {
  return table().typed(table().defaults().with(name, text, "--set"));
}

std::string refusal(const char* name, const std::string& text) {
  return thrownBy([&] { with(name, text); });
}

std::string tomlRefusal(const std::string& text) {
  return thrownBy(
      [&] { (void)table().defaults().with(TomlDocument::parseText(text, "p.toml").root()); });
}

TEST(TextParameter, TakesWhatIsAllowed) {
  EXPECT_EQ(table().typed(table().defaults()), Parameters());
  EXPECT_EQ(with("title", "Élan \"vital\"").title, "Élan \"vital\"");
  EXPECT_EQ(with("style", "ink").style, "ink");
  EXPECT_EQ(with("scene", "a b/desk.toml").scene, fs::path("a b/desk.toml"));
  EXPECT_EQ(with("profile", "SITE.TOML").profile, fs::path("SITE.TOML"));
  EXPECT_EQ(with("scene", "synthetic").scene, fs::path("synthetic"));
  EXPECT_EQ(with("profile", "./none.toml").profile, fs::path("./none.toml"));
  EXPECT_EQ(with("size", "1280x720").size, (PixelSize{1280, 720}));
  EXPECT_EQ(with("size", "camera").size, PixelSize());
}

TEST(TextParameter, SaysWhatIsAllowed) {
  EXPECT_EQ(refusal("title", ""), "--set: title: found \"\", allowed: a title");
  EXPECT_EQ(refusal("style", "in"), "--set: style: found \"in\", allowed: one of oil, ink");
  EXPECT_EQ(refusal("style", "oill"),
            "--set: style: found \"oill\" (did you mean \"oil\"?), allowed: one of oil, ink");
  EXPECT_EQ(refusal("scene", ""), "--set: scene: found \"\", allowed: none, synthetic, or a path");
  EXPECT_EQ(refusal("scene", "synthetic:pan"),
            "--set: scene: found \"synthetic:pan\", allowed: none, synthetic, or a path");
  EXPECT_EQ(refusal("profile", "nonne"),
            "--set: profile: found \"nonne\" (did you mean \"none\"?), allowed: none, or a path "
            "that ends in .toml");
  EXPECT_EQ(refusal("size", "640"),
            "--set: size: found \"640\", allowed: camera, or WIDTHxHEIGHT, at most 8192 px a side "
            "and 64 Mpx, such as 1280x720");
  EXPECT_NE(refusal("title", std::string(256, 'a')), "(nothing thrown)");
  EXPECT_NE(refusal("title", "two\nlines"), "(nothing thrown)");
  EXPECT_NE(refusal("scene", std::string(4097, 'a')), "(nothing thrown)");
  EXPECT_NE(refusal("scene", std::string("a\0b", 3)), "(nothing thrown)");
  EXPECT_EQ(refusal("frame", "camera"),
            "--set: frame: found \"camera\", allowed: WIDTHxHEIGHT, at most 8192 px a side and 64 "
            "Mpx, such as 1280x720");
}

TEST(TextParameter, TakesSizesStrictly) {
  for (const char* size : {"640", "640x", "x480", "640x480x3", "0x480", "0x0", "-640x480",
                           "9000x9000", "8192x8192", "wide", "640x480 ", "640x 480", " 640x480",
                           "+640x480", "640x+480", "640X480", "99999999999x480", ""}) {
    EXPECT_NE(refusal("size", size), "(nothing thrown)") << size;
    EXPECT_NE(refusal("frame", size), "(nothing thrown)") << size;
  }
  EXPECT_EQ(with("size", "8192x7812").size, (PixelSize{8192, 7812}));
  EXPECT_EQ(with("size", "1x1").size, (PixelSize{1, 1}));
}

TEST(TextParameter, SaysWhereTomlIsWrong) {
  EXPECT_EQ(tomlRefusal("\nscene = 3"),
            "p.toml:2: scene: found 3 (integer), allowed: none, synthetic, or a path");
  EXPECT_EQ(
      tomlRefusal("size = [640, 480]"),
      "p.toml:1: size: found an array of 2, allowed: camera, or WIDTHxHEIGHT, at most 8192 px "
      "a side and 64 Mpx, such as 1280x720");
  EXPECT_EQ(tomlRefusal("size = \"camer\""),
            "p.toml:1: size: found \"camer\" (did you mean \"camera\"?), allowed: camera, or "
            "WIDTHxHEIGHT, at most 8192 px a side and 64 Mpx, such as 1280x720");
  EXPECT_EQ(tomlRefusal("style = \"inkk\""),
            "p.toml:1: style: found \"inkk\" (did you mean \"ink\"?), allowed: oil, ink");
  EXPECT_NE(tomlRefusal("scene = \"a\\u0000b\""), "(nothing thrown)");
}

TEST(TextParameter, RelativePathsOfAFileStartAtTheFile) {
  const support::TemporaryFolder folder;
  const fs::path file = folder.path() / "site.toml";
  const auto sceneOf = [&](const std::string& text) {
    std::ofstream(file) << text;
    return table().typed(table().defaults().with(TomlDocument::parseFile(file).root())).scene;
  };
  EXPECT_EQ(sceneOf("scene = \"a/desk.toml\""), folder.path() / "a/desk.toml");
  EXPECT_EQ(sceneOf("scene = \"/srv/desk.toml\""), fs::path("/srv/desk.toml"));
  EXPECT_EQ(sceneOf("scene = \"none\""), fs::path("none"));
}

struct Source {
  fs::path source = "none";
};

TEST(TextParameter, NamesThatGoOnAfterAColonAreNoPaths) {
  const ParameterTable<Source> sources{pathParameter("source", &Source::source, {"none", "usb"},
                                                     "Where from.", TakesEffect::kRestart, {},
                                                     {"usb:ID", "serial:NUMBER"})};
  const support::TemporaryFolder folder;
  const fs::path file = folder.path() / "site.toml";
  const auto sourceOf = [&](const std::string& text) {
    std::ofstream(file) << "source = \"" << text << "\"";
    return sources.typed(sources.defaults().with(TomlDocument::parseFile(file).root())).source;
  };
  for (const std::string name : {"usb:046d:0825", "usb:/dev/video0", "serial:A"}) {
    EXPECT_EQ(sourceOf(name), fs::path(name));
    EXPECT_THAT(sources.defaults().with("source", name, "--set").toToml(),
                testing::HasSubstr("source = \"" + name + "\"  # --set\n"));
  }
  EXPECT_EQ(sourceOf("serials"), folder.path() / "serials");
  EXPECT_EQ(sourceOf("serial:"), folder.path() / "serial:");
  EXPECT_THAT(thrownBy([&] { sourceOf("usb:"); }), testing::HasSubstr("allowed: usb, usb:ID"));
}

TEST(TextParameter, SurvivesPrintingAndParsing) {
  const Parameters given{.title = "a \"b\" \\ Ünï # no comment",
                         .style = "ink",
                         .scene = "/srv/a \t\"b\"/\x7f.toml",
                         .profile = "/p.toml",
                         .size = {1280, 720}};
  const ParameterValues values = table().valuesOf(given, "host");
  const auto document = TomlDocument::parseText(values.toToml(), "p.toml", "/elsewhere");
  EXPECT_EQ(table().typed(table().defaults().with(document.root())), given) << values.toToml();
}

TEST(TextParameter, PrintsRelativePathsAbsolute) {
  const std::string toml = table().defaults().with("scene", "a/../desk.toml", "--set").toToml();
  const std::string path = (fs::current_path() / "desk.toml").string();
  EXPECT_THAT(toml, testing::HasSubstr("scene = \"" + path + "\"  # --set\n"));
}

TEST(TextParameter, RefusesToPrintWhatTomlCannotHold) {
  for (const std::string bytes : {"\xff", "caf\xe9", "\xc3", "\xed\xa0\x80", "\xc0\xaf"}) {
    const ParameterValues values = table().defaults().with("scene", "/" + bytes, "--set");
    EXPECT_THAT(thrownBy([&] { (void)values.toToml(); }), testing::HasSubstr("UTF-8")) << bytes;
  }
}

TEST(TextParameter, NoOriginBreaksTheFile) {
  const std::string origin = "a\nscene = \"x\"\r\xff\x01.toml:3";
  const std::string toml = table().defaults().with("title", "t", origin).toToml();
  const auto document = TomlDocument::parseText(toml, "p.toml");
  EXPECT_EQ(table().typed(table().defaults().with(document.root())).title, "t") << toml;
  EXPECT_THAT(toml, testing::HasSubstr("title = \"t\"  # a?scene = \"x\"???.toml:3\n"));
}

// ---- lists

struct Lists {
  std::vector<fs::path> sources{"none"};
};

const ParameterTable<Lists>& lists() {
  static const ParameterTable<Lists> kTable{pathListParameter(
      "sources", &Lists::sources, {.min = 1, .max = 3}, {"none"}, {"serial:NUMBER"},
      "What is read.", "a path", [](std::string_view text) { return text != "bad"; })};
  return kTable;
}

TEST(PathListParameter, IsWrittenWithCommas) {
  for (const std::string text : {"none", "a", "a,b c,serial:1", "a\\,b,c\\\\d", "none,/x/"}) {
    const ParameterValues values = lists().defaults().with("sources", text, "--set");
    EXPECT_EQ(values.text("sources"), text);
  }
  EXPECT_THAT(lists().typed(lists().defaults().with("sources", "a\\,b,c\\\\d", "--set")).sources,
              testing::ElementsAre("a,b", "c\\d"));
  for (const std::string text : {"", ",", "a,", "a,b,c,d", "a\\", "a\\b", "none:1", "a,bad"}) {
    EXPECT_THROW((void)lists().defaults().with("sources", text, "--set"), ConfigError) << text;
  }
}

TEST(PathListParameter, IsAnArrayInAFile) {
  const auto read = [](const std::string& array) {
    const auto document = TomlDocument::parseText("sources = " + array, "a.toml", "/folder");
    return lists().defaults().with(document.root());
  };
  EXPECT_THAT(lists().typed(read(R"(["none", "a", "serial:7"])")).sources,
              testing::ElementsAre("none", "/folder/a", "serial:7"));
  EXPECT_THAT(read(R"(["none", "a,\"b"])").toToml(),
              testing::HasSubstr(R"(sources = ["none", "/folder/a,\"b"]  # a.toml:1)"));
  for (const std::string array : {"[]", "\"a\"", "[1]", R"(["a", "b", "c", "d"])", R"(["bad"])"}) {
    EXPECT_THROW(read(array), ConfigError) << array;
  }
}

}  // namespace
}  // namespace pleinair::config
