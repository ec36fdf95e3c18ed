#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pleinair::hal {
namespace {

namespace fs = std::filesystem;

/// hal::Answer is made of it.
constexpr std::array kExcepted{"hal/error.h"};

std::vector<std::string> headersWith(const fs::path& root, const std::string& text) {
  std::vector<std::string> found;
  for (const char* module : {"hal", "config", "pipeline", "firmware_app"}) {
    for (const auto& entry : fs::recursive_directory_iterator(root / module)) {
      if (entry.path().extension() != ".h") continue;
      std::ifstream file(entry.path());
      const std::string code{std::istreambuf_iterator<char>(file),
                             std::istreambuf_iterator<char>()};
      if (code.find(text) != std::string::npos) {
        found.push_back(fs::relative(entry.path(), root).generic_string());
      }
    }
  }
  return found;
}

/// `if (result)` asks for the error, and is easily taken for the bool: a function that answers yes
/// or no, or fails, returns a hal::Answer or an enumeration.
TEST(ResultType, HoldsNoBoolInAnyHeader) {
  const fs::path root = fs::path(PLEINAIR_TESTS_DIR).parent_path();
  ASSERT_THAT(headersWith(root, "#pragma once"), testing::SizeIs(testing::Gt(100U)));
  std::vector<std::string> found = headersWith(root, "Result<bool>");
  std::erase_if(found, [](const std::string& header) {
    return std::ranges::find(kExcepted, header) != kExcepted.end();
  });
  EXPECT_THAT(found, testing::IsEmpty());
}

}  // namespace
}  // namespace pleinair::hal
