#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pleinair {
namespace {

namespace fs = std::filesystem;
using testing::IsEmpty;

const fs::path kTests = PLEINAIR_TESTS_DIR;
const fs::path kTop = kTests.parent_path();

/// Modules by name, each with the modules that it may include.
using Graph = std::map<std::string, std::set<std::string>>;

std::string textOf(const fs::path& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// The declared graph: a line "module: module …" each; "#" begins a comment.
Graph parseGraph(const std::string& text) {
  Graph graph;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    line = line.substr(0, line.find('#'));
    const std::size_t colon = line.find(':');
    if (colon == std::string::npos) continue;
    std::set<std::string>& allowed = graph[line.substr(0, colon)];
    std::istringstream words(line.substr(colon + 1));
    for (std::string word; words >> word;) allowed.insert(word);
  }
  return graph;
}

/// The module of a source or header: the longest declared name that is its folder, or that names
/// the file without its ending. Empty where none is.
std::string moduleOf(const Graph& graph, const std::string& file) {
  fs::path path = file;
  path.replace_extension();
  for (; !path.empty(); path = path.parent_path()) {
    if (graph.contains(path.string())) return path.string();
  }
  return {};
}

std::vector<std::string> productSources() {
  std::vector<std::string> files;
  for (const char* const part : {"config", "firmware_app", "hal", "pipeline"}) {
    for (const auto& entry : fs::recursive_directory_iterator(kTop / part)) {
      const fs::path ending = entry.path().extension();
      if (ending == ".h" || ending == ".cpp") {
        files.push_back(fs::relative(entry.path(), kTop).string());
      }
    }
  }
  std::ranges::sort(files);
  return files;
}

/// Files of the product that a file includes; headers that the build makes count as files of the
/// folder they are named for.
std::vector<std::string> includesOf(const std::string& text) {
  static const std::regex kInclude(
      R"re(#include "((?:config|firmware_app|hal|pipeline)/[^"]+)")re");
  std::vector<std::string> found;
  for (std::sregex_iterator match(text.begin(), text.end(), kInclude), end; match != end; ++match) {
    found.push_back((*match)[1]);
  }
  return found;
}

/// Includes that the graph does not allow, and files outside all modules.
std::vector<std::string> violationsOf(const Graph& graph, const std::string& file,
                                      const std::string& text, Graph& used) {
  std::vector<std::string> violations;
  const std::string from = moduleOf(graph, file);
  if (from.empty()) violations.push_back(file + " belongs to no declared module");
  for (const std::string& include : includesOf(text)) {
    const std::string to = moduleOf(graph, include);
    if (to == from) continue;
    used[from].insert(to);
    if (from.empty() || !graph.at(from).contains(to)) {
      violations.push_back(file + " includes " + include + ": \"" + from + "\" may not include \"" +
                           to + "\"");
    }
  }
  return violations;
}

/// A module that can reach itself, or an empty string.
std::string cycleIn(const Graph& graph) {
  enum class Mark { kNew, kOpen, kDone };
  std::map<std::string, Mark> marks;
  std::string found;
  const auto visit = [&](const auto& self, const std::string& module) -> void {
    marks[module] = Mark::kOpen;
    const auto at = graph.find(module);
    if (at != graph.end()) {
      for (const std::string& next : at->second) {
        if (marks[next] == Mark::kOpen) found = next;
        if (marks[next] == Mark::kNew) self(self, next);
      }
    }
    marks[module] = Mark::kDone;
  };
  for (const auto& [module, allowed] : graph) {
    if (marks[module] == Mark::kNew) visit(visit, module);
  }
  return found;
}

/// The module at the level that the picture in the documents shows.
std::string groupOf(const std::string& module) {
  const std::size_t first = module.find('/');
  if (first == std::string::npos) return module;
  std::string top = module.substr(0, first);
  if (top == "firmware_app" || top == "config") return top;
  return module.substr(0, module.find('/', first + 1));
}

/// The groups and their edges for Mermaid, without those that follow from others.
std::string pictureOf(const Graph& graph) {
  Graph groups;
  for (const auto& [module, allowed] : graph) {
    for (const std::string& to : allowed) {
      if (groupOf(to) != groupOf(module)) groups[groupOf(module)].insert(groupOf(to));
    }
  }
  const auto reaches = [&](const auto& self, const std::string& from,
                           const std::string& to) -> bool {
    const auto at = groups.find(from);
    if (at == groups.end()) return false;
    return std::ranges::any_of(
        at->second, [&](const std::string& next) { return next == to || self(self, next, to); });
  };
  std::string picture = "```mermaid\ngraph TD\n";
  for (const auto& [from, allowed] : groups) {
    for (const std::string& to : allowed) {
      const bool isImplied = std::ranges::any_of(allowed, [&](const std::string& other) {
        return other != to && reaches(reaches, other, to);
      });
      if (!isImplied) picture += "  " + from + " --> " + to + "\n";
    }
  }
  return picture + "```\n";
}

class IncludeGraph : public testing::Test {
 protected:
  Graph graph_ = parseGraph(textOf(kTests / "unit/architecture/modules.txt"));
};

TEST_F(IncludeGraph, AllowsEveryInclude) {
  std::vector<std::string> violations;
  Graph used;
  for (const std::string& file : productSources()) {
    std::ranges::move(violationsOf(graph_, file, textOf(kTop / file), used),
                      std::back_inserter(violations));
  }
  EXPECT_THAT(violations, IsEmpty());

  std::vector<std::string> unused;
  for (const auto& [from, allowed] : graph_) {
    for (const std::string& to : allowed) {
      if (!used[from].contains(to)) unused.push_back(from + " -> " + to);
    }
  }
  EXPECT_THAT(unused, IsEmpty()) << "edges that modules.txt allows and nothing uses";
}

TEST_F(IncludeGraph, HasNoCycle) {
  EXPECT_EQ(cycleIn(graph_), "");
}

TEST_F(IncludeGraph, PointsFromTheProgramToThePipelineToTheHalToTheConfiguration) {
  std::vector<std::string> wrong;
  const std::map<std::string, int> ranks{
      {"config", 0}, {"hal", 1}, {"pipeline", 2}, {"firmware_app", 3}};
  const auto topOf = [](const std::string& module) { return module.substr(0, module.find('/')); };
  for (const auto& [from, allowed] : graph_) {
    for (const std::string& to : allowed) {
      if (ranks.at(topOf(to)) > ranks.at(topOf(from))) wrong.push_back(from + " -> " + to);
    }
  }
  EXPECT_THAT(wrong, IsEmpty());
}

TEST_F(IncludeGraph, IsThePictureInTheDocuments) {
  const std::string document = textOf(kTop / "docs/architecture.md");
  constexpr std::string_view kBegin = "<!-- modules begin -->\n";
  constexpr std::string_view kEnd = "<!-- modules end -->";
  const std::size_t begin = document.find(kBegin);
  const std::size_t end = document.find(kEnd);
  ASSERT_NE(begin, std::string::npos);
  ASSERT_NE(end, std::string::npos);
  const std::string shown = document.substr(begin + kBegin.size(), end - begin - kBegin.size());
  EXPECT_EQ(shown, pictureOf(graph_)) << "put this between the markers of docs/architecture.md:\n"
                                      << pictureOf(graph_);
}

TEST(IncludeGraphCheck, FindsAnIncludeThatIsNotAllowed) {
  const Graph graph = parseGraph("hal:\npipeline/a: hal\npipeline/a/registry: pipeline/a\n");
  Graph used;
  EXPECT_THAT(violationsOf(graph, "pipeline/a/x.cpp", "#include \"hal/clock.h\"\n", used),
              IsEmpty());
  EXPECT_EQ(violationsOf(graph, "hal/x.cpp", "#include \"pipeline/a/y.h\"\n", used).size(), 1U);
  EXPECT_EQ(violationsOf(graph, "pipeline/b/x.cpp", "", used).size(), 1U);
  EXPECT_THAT(violationsOf(graph, "pipeline/a/registry.cpp", "#include \"pipeline/a/y.h\"\n", used),
              IsEmpty());
}

TEST(IncludeGraphCheck, FindsACycle) {
  EXPECT_EQ(cycleIn(parseGraph("a: b\nb: c\nc:\n")), "");
  EXPECT_NE(cycleIn(parseGraph("a: b\nb: c\nc: a\n")), "");
}

}  // namespace
}  // namespace pleinair
