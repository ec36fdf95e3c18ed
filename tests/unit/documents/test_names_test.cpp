// Some documents name the tests that hold what they say; a test that is renamed must not leave them
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

/// Checks the names in a document; gives how many there are.
int checkNamesIn(const char* document) {
  static const std::regex kNamed(R"(`(?:\w+/)?([A-Z]\w+\.(?:[A-Z]\w+|\*))(?:/\d+)?`)");
  static const std::set<std::string> known = testNames();
  const std::string text = contentOf(kTestsFolder.parent_path() / document);
  int count = 0;
  for (std::sregex_iterator each(text.begin(), text.end(), kNamed), end; each != end;
       ++each, ++count) {
    EXPECT_TRUE(known.contains((*each)[1].str()))
        << document << ": there is no test " << (*each)[1].str();
  }
  return count;
}

TEST(TestNames, OfEverydayUseAreThoseOfTests) {
  EXPECT_GT(checkNamesIn("docs/everyday.md"), 60) << "the names are not found";
}

TEST(TestNames, OfTheRepairStationAreThoseOfTests) {
  EXPECT_GT(checkNamesIn("docs/repair-station.md"), 25) << "the names are not found";
}

}  // namespace
}  // namespace pleinair
