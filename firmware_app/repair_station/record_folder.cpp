#include "firmware_app/repair_station/record_folder.h"

#include <algorithm>
#include <ctime>
#include <functional>
#include <system_error>
#include <variant>
#include <vector>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "pipeline/record/record_check.h"

namespace pleinair::app {
namespace {

namespace fs = std::filesystem;

/// A name of a file: what is not a letter, digit, '-' or '_' becomes '_'.
std::string fileNameOf(const std::string& text) {
  std::string name;
  for (const char c : text) {
    const bool isKept = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                        (c >= '0' && c <= '9') || c == '-' || c == '_';
    name += isKept ? c : '_';
  }
  return name;
}

}  // namespace

std::optional<fs::path> openRecordIn(const fs::path& folder, const std::string& procedure) {
  std::vector<fs::path> records;
  std::error_code failure;
  for (fs::directory_iterator at(folder, failure), end; !failure && at != end;
       at.increment(failure)) {
    if (at->path().extension() == ".jsonl") records.push_back(at->path());
  }
  std::ranges::sort(records, std::ranges::greater());
  for (const fs::path& each : records) {
    const auto reading = record::checkRecordFile(each);
    if (!reading || reading->entries.empty()) continue;
    const auto* begun = std::get_if<record::Begun>(&reading->entries.front().event);
    if (begun == nullptr || begun->procedure != procedure) continue;
    if (!reading->isSignedOff()) return each;
    return std::nullopt;
  }
  return std::nullopt;
}

fs::path newRecordIn(const fs::path& folder, const std::string& procedure) {
  const std::time_t now = std::time(nullptr);
  const std::string stem =
      fmt::format("{}-{:%Y%m%d-%H%M%S}", fileNameOf(procedure), fmt::gmtime(now));
  fs::path path = folder / (stem + ".jsonl");
  for (int number = 2; fs::exists(path); ++number) {
    path = folder / fmt::format("{}-{}.jsonl", stem, number);
  }
  return path;
}

}  // namespace pleinair::app
