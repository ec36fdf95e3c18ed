// docs/everyday.md names the tests that hold what it says; a test that is renamed must not leave it
// without proof.
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <string>

#include <gtest/gtest.h>

namespace pleinair {
namespace {

namespace fs = std::filesystem;

const fs::path kTestsFolder = PLEINAIR_TESTS_DIR;

std::string contentOf(const fs::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// "Suite.Name" and "Suite.*" of all tests, without prefixes of parametrised ones.
std::set<std::string> testNames() {
  static const std::regex kTest(R"(\bTEST(?:_F|_P)?\(\s*(\w+),\s*(\w+)\s*\))");
  std::set<std::string> names;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(kTestsFolder)) {
    if (entry.path().extension() != ".cpp") continue;
    const std::string source = contentOf(entry.path());
    for (std::sregex_iterator each(source.begin(), source.end(), kTest), end; each != end; ++each) {
      names.insert((*each)[1].str() + "." + (*each)[2].str());
      names.insert((*each)[1].str() + ".*");
    }
  }
  return names;
}

TEST(TestNames, OfEverydayUseAreThoseOfTests) {
  static const std::regex kNamed(R"(`(?:\w+/)?([A-Z]\w+\.(?:[A-Z]\w+|\*))(?:/\d+)?`)");
  const std::string document = contentOf(kTestsFolder.parent_path() / "docs/everyday.md");
  const std::set<std::string> known = testNames();
  int count = 0;
  for (std::sregex_iterator each(document.begin(), document.end(), kNamed), end; each != end;
       ++each, ++count) {
    EXPECT_TRUE(known.contains((*each)[1].str())) << "there is no test " << (*each)[1].str();
  }
  EXPECT_GT(count, 60) << "the names are not found";
}

}  // namespace
}  // namespace pleinair
