// Documents refer to each other and to files of the tree; a rename must not leave a dead link.
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>

namespace pleinair {
namespace {

namespace fs = std::filesystem;

const fs::path kRoot = fs::path(PLEINAIR_TESTS_DIR).parent_path();

std::string textOf(const fs::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// The lines outside fenced blocks.
std::vector<std::string> proseOf(const fs::path& document) {
  std::vector<std::string> lines;
  std::ifstream file(document);
  bool isFenced = false;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("```")) {
      isFenced = !isFenced;
    } else if (!isFenced) {
      lines.push_back(line);
    }
  }
  return lines;
}

/// The anchor that a heading gets: lower case, words joined by hyphens, no punctuation.
std::string anchorOf(const std::string& heading) {
  std::string anchor;
  for (const char c : heading) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x80 || std::isalnum(byte) != 0 || c == '_' || c == '-') {
      anchor += static_cast<char>(std::tolower(byte));
    } else if (c == ' ') {
      anchor += '-';
    }
  }
  return anchor;
}

std::set<std::string> anchorsOf(const fs::path& document) {
  std::set<std::string> anchors;
  for (const std::string& line : proseOf(document)) {
    const std::size_t level = line.find_first_not_of('#');
    if (level == 0 || level == std::string::npos || line[level] != ' ') continue;
    anchors.insert(anchorOf(line.substr(level + 1)));
  }
  return anchors;
}

std::vector<fs::path> documents() {
  std::vector<fs::path> found{kRoot / "README.md", kRoot / "CONTRIBUTING.md",
                              kRoot / "CHANGELOG.md", kRoot / "tests/system/README.md"};
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(kRoot / "docs")) {
    if (entry.path().extension() == ".md") found.push_back(entry.path());
  }
  std::ranges::sort(found);
  return found;
}

/// Why the link does not lead anywhere, or nothing.
std::string problemOf(const fs::path& document, const std::string& link) {
  const std::size_t hash = link.find('#');
  const std::string file = link.substr(0, hash);
  const fs::path target = file.empty() ? document : document.parent_path() / file;
  if (!fs::exists(target)) return "there is no such file";
  if (hash == std::string::npos || target.extension() != ".md") return {};
  const bool isThere = anchorsOf(target).contains(link.substr(hash + 1));
  return isThere ? "" : "there is no such heading";
}

TEST(DocumentLinks, LeadToFilesAndHeadings) {
  static const std::regex kLink(R"(\]\(([^)\s]+)\))");
  int links = 0;
  for (const fs::path& document : documents()) {
    for (const std::string& line : proseOf(document)) {
      for (std::sregex_iterator at(line.begin(), line.end(), kLink), end; at != end; ++at) {
        const std::string link = (*at)[1];
        if (link.find("://") != std::string::npos) continue;
        ++links;
        const std::string problem = problemOf(document, link);
        EXPECT_TRUE(problem.empty()) << document << ": " << link << ": " << problem;
      }
    }
  }
  EXPECT_GT(links, 100);
}

TEST(DocumentLinks, AWrongLinkIsFound) {
  const fs::path readme = kRoot / "README.md";
  EXPECT_EQ(problemOf(readme, "docs/glossary.md#tracking"), "");
  EXPECT_EQ(problemOf(readme, "docs/glosary.md"), "there is no such file");
  EXPECT_EQ(problemOf(readme, "docs/glossary.md#traking"), "there is no such heading");
}

TEST(Decisions, HaveStatusDateAndPartsAndAreInTheIndex) {
  const std::string index = textOf(kRoot / "docs/decisions/README.md");
  int decisions = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(kRoot / "docs/decisions")) {
    const std::string name = entry.path().filename().string();
    if (name == "README.md") continue;
    SCOPED_TRACE(name);
    ++decisions;
    const std::string text = textOf(entry.path());
    EXPECT_THAT(text, testing::HasSubstr("\n- Status: "));
    EXPECT_TRUE(std::regex_search(text, std::regex("\n- Date: [0-9]{4}-[0-9]{2}-[0-9]{2}\n")));
    for (const char* const part : {"\n## Context\n", "\n## Decision\n", "\n## Alternatives\n"}) {
      EXPECT_THAT(text, testing::HasSubstr(part));
    }
    EXPECT_THAT(index, testing::HasSubstr("(" + name + ")"));
  }
  EXPECT_GE(decisions, 22);
}

}  // namespace
}  // namespace pleinair
