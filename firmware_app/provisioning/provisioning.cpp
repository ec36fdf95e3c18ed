#include "firmware_app/provisioning/provisioning.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <map>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "config/config_error.h"
#include "firmware_app/provisioning/bundle.h"
#include "firmware_app/provisioning/kept_site.h"
#include "hal/error.h"

namespace pleinair::app {
namespace {

namespace fs = std::filesystem;

/// People know the file by its name on their medium, not by the copy's.
std::string without(std::string text, const std::string& folder) {
  const std::string prefix = folder + "/";
  for (std::size_t at = 0; (at = text.find(prefix, at)) != std::string::npos;) {
    text.erase(at, prefix.size());
  }
  return text;
}

std::vector<std::string> linesOf(const std::string& text) {
  std::vector<std::string> lines{""};
  for (const char c : text) {
    if (c == '\n') {
      lines.emplace_back();
    } else {
      lines.back() += c;
    }
  }
  return lines;
}

bool beginsTable(const std::string& line) {
  const std::size_t first = line.find_first_not_of(" \t");
  return first != std::string::npos && line[first] == '[';
}

/// Takes a wrong line out, or a whole table whose name is wrong, so that the next error is found.
void takeOut(std::vector<std::string>& lines, int line) {
  const auto at = static_cast<std::size_t>(line - 1);
  if (at >= lines.size()) return;
  const bool isTable = beginsTable(lines[at]);
  lines[at].clear();
  for (std::size_t i = at + 1; isTable && i < lines.size() && !beginsTable(lines[i]); ++i) {
    lines[i].clear();
  }
}

std::string contentOf(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

std::string fingerprintOfPlaces(const std::vector<fs::path>& folders) {
  for (const fs::path& folder : folders) {
    std::string fingerprint = fingerprintOf(folder);
    if (!fingerprint.empty()) return fingerprint;
  }
  return {};
}

/// Takes a bundle into the state folder and puts it in force. Returns what is wrong with it.
std::vector<std::string> take(const fs::path& source, const KeptSite& kept, const SiteCheck& check,
                              std::optional<KeptSite::Copy>& inForce) {
  const hal::Result<Bundle> bundle = readBundle(source);
  if (!bundle) return {bundle.error().message()};
  if (inForce && inForce->digest == digestOf(*bundle)) return {};
  const auto copy = kept.write(*bundle);
  if (!copy) return {copy.error().message()};
  std::vector<std::string> problems = problemsOf(copy->siteFile(), check);
  if (problems.empty()) {
    const auto put = kept.putInForce(*copy);
    if (put) {
      inForce = *copy;
      return {};
    }
    problems.push_back(put.error().message());
  }
  kept.discard(*copy);
  return problems;
}

}  // namespace

ProvisioningPlaces ProvisioningPlaces::of(const std::optional<fs::path>& folder, fs::path state) {
  ProvisioningPlaces places{.folders = {}, .state = std::move(state)};
  const char* const credentials = std::getenv("CREDENTIALS_DIRECTORY");
  if (credentials != nullptr && hasSite(credentials)) places.folders.emplace_back(credentials);
  if (folder) places.folders.push_back(*folder);
  return places;
}

Provisioned provision(const ProvisioningPlaces& places, const SiteCheck& check) {
  const KeptSite kept(places.state);
  std::optional<KeptSite::Copy> inForce = kept.inForce();
  const std::optional<KeptSite::Copy> before = inForce;
  Provisioned provisioned;
  const auto source = std::ranges::find_if(places.folders, hasSite);
  if (source != places.folders.end()) {
    provisioned.found = source->string();
    provisioned.problems = take(*source, kept, check, inForce);
  }
  // What was good for another version of the program need not be for this one.
  if (inForce && before && inForce->digest == before->digest) {
    std::vector<std::string> problems = problemsOf(inForce->siteFile(), check);
    if (!problems.empty()) {
      inForce.reset();
      if (provisioned.problems.empty()) provisioned.problems = std::move(problems);
    }
  }
  if (!inForce) return provisioned;
  provisioned.siteFile = inForce->siteFile();
  const bool isKept = provisioned.found.empty() || !provisioned.problems.empty();
  provisioned.origin = isKept ? places.state.string() : provisioned.found;
  return provisioned;
}

std::optional<fs::path> keptSiteFile(const fs::path& state) {
  const auto copy = KeptSite(state).inForce();
  return copy ? std::optional(copy->siteFile()) : std::nullopt;
}

std::vector<std::string> problemsOf(const fs::path& siteFile, const SiteCheck& check) {
  const std::string folder = siteFile.parent_path().string();
  std::multimap<int, std::string> byLine;
  std::vector<std::string> lines = linesOf(contentOf(siteFile));
  std::optional<std::string> text;
  while (byLine.size() < kMostProblems) {
    try {
      check(siteFile, text);
      break;
    } catch (const config::ConfigError& error) {
      const bool isInSite = error.line() > 0 && error.file() == siteFile.string();
      const bool isOfKey = isInSite && !error.key().empty();
      // Without the lines taken out, it may be no TOML any more.
      if (!byLine.empty() && !isOfKey) break;
      byLine.emplace(error.line(), without(error.what(), folder));
      if (!isOfKey) break;
      takeOut(lines, error.line());
      text = fmt::format("{}", fmt::join(lines, "\n"));
    } catch (const hal::Failure& error) {
      if (byLine.empty()) byLine.emplace(0, without(error.what(), folder));
      break;
    }
  }
  std::vector<std::string> problems;
  for (auto& [line, problem] : byLine) problems.push_back(std::move(problem));
  return problems;
}

std::string provisioningText(const Provisioned& provisioned, bool hasOther) {
  if (!provisioned.problems.empty()) {
    std::string text = provisioned.siteFile
                           ? "site.toml is not in force; the one before it still is:"
                           : "site.toml is not in force, and there is none before it:";
    for (const std::string& each : provisioned.problems) text += "\n" + each;
    return text;
  }
  if (provisioned.siteFile || hasOther) return {};
  return "Not set up yet: this is how it paints by itself.\n"
         "Put a file site.toml on the FAT partition PLEINAIR: on a machine image that of\n"
         "its own disk, elsewhere a USB stick of that name. Such as\n"
         "  [painting]\n"
         "  look = \"wet_in_wet\"\n"
         "An empty file puts this text away. More: appliance.md, \"Setting it up\"";
}

SiteWatch::SiteWatch(const ProvisioningPlaces& places, hal::Duration interval)
    : first_(fingerprintOfPlaces(places.folders)),
      looks_(
          "site",
          [folders = places.folders, last = Seen{}]() mutable {
            std::string now = fingerprintOfPlaces(folders);
            last.times = now == last.fingerprint ? last.times + 1 : 1;
            last.fingerprint = std::move(now);
            last.wasGone = last.wasGone || last.fingerprint.empty();
            return last;
          },
          interval) {}

bool SiteWatch::hasChanged(bool hadProblems) const {
  const auto look = looks_.latest();
  if (!look || look->value.times < 2 || look->value.fingerprint.empty()) return false;
  return look->value.fingerprint != first_ || (hadProblems && look->value.wasGone);
}

std::uint64_t SiteWatch::looks() const {
  const auto look = looks_.latest();
  return look ? look->number : 0;
}

}  // namespace pleinair::app
