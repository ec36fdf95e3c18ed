#include "pipeline/record/record_check.h"

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <system_error>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "pipeline/digest/sha256.h"

namespace pleinair::record {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMaxRecordBytes = std::uintmax_t{256} << 20U;

/// Why `entry` does not follow the lines so far, or nothing.
std::string linkFault(const RecordReading& reading, const RecordEntry& entry) {
  const std::uint64_t expected = reading.entries.size();
  if (entry.number != expected) {
    return fmt::format(
        "is line {} of its record, where line {} belongs: lines were removed, "
        "repeated or swapped",
        entry.number + 1, expected + 1);
  }
  if (entry.previous != reading.finalHash()) {
    return "does not follow the line before: one of them is of another record";
  }
  if (expected == 0 && !std::holds_alternative<Begun>(entry.event)) {
    return "does not begin a record";
  }
  if (expected > 0 && std::holds_alternative<Begun>(entry.event)) return "begins another record";
  if (reading.isSignedOff()) return "comes after the sign-off";
  return {};
}

/// Since the machine was switched on, time only goes on, whatever is done to its clock.
std::string timeFault(const RecordReading& reading, const RecordEntry& entry) {
  if (reading.entries.empty()) return {};
  const Moment& before = reading.entries.back().moment;
  const bool isSameBoot = !before.boot.empty() && before.boot == entry.moment.boot;
  if (!isSameBoot || entry.moment.monotonic >= before.monotonic) return {};
  return "was written before the line before it";
}

void noteClock(RecordReading& reading, const RecordEntry& entry) {
  if (reading.entries.empty()) return;
  const Moment& before = reading.entries.back().moment;
  const auto back = before.wall - entry.moment.wall;
  if (back <= std::chrono::milliseconds(0)) return;
  reading.notes.push_back(
      fmt::format("line {}: the wall clock was set back by {:.1f} s; the monotonic time and the "
                  "order of lines hold",
                  entry.number + 1, std::chrono::duration<double>(back).count()));
}

void checkStills(RecordReading& reading, const fs::path& folder) {
  for (const RecordEntry& entry : reading.entries) {
    const auto* still = std::get_if<StillTaken>(&entry.event);
    if (still == nullptr) continue;
    const std::optional<fs::path> file = pathOfStill(*still, folder);
    const auto hash = file ? digest::hexOfFile(*file)
                           : tl::unexpected(hal::Error{.problem = "is not beside the record"});
    if (!hash) {
      reading.findings.push_back(
          {entry.number + 1, fmt::format("still {}: {}", still->file, hash.error().problem)});
    } else if (*hash != still->sha256) {
      reading.findings.push_back(
          {entry.number + 1, fmt::format("still {} was changed", still->file)});
    }
  }
}

}  // namespace

std::optional<fs::path> pathOfStill(const StillTaken& still, const fs::path& folder) {
  const fs::path file(still.file);
  if (file.empty() || file.is_absolute()) return std::nullopt;
  // Links are followed: one may lead out of the folder.
  std::error_code failure;
  const fs::path base = fs::weakly_canonical(folder.empty() ? fs::path(".") : folder, failure);
  if (failure) return std::nullopt;
  const fs::path whole = fs::weakly_canonical(base / file, failure);
  if (failure) return std::nullopt;
  const fs::path within = whole.lexically_relative(base);
  if (within.empty() || *within.begin() == ".." || *within.begin() == ".") return std::nullopt;
  return whole;
}

bool RecordReading::isSignedOff() const {
  return !entries.empty() && std::holds_alternative<SignedOff>(entries.back().event);
}

const std::string& RecordReading::finalHash() const {
  return entries.empty() ? noHash() : entries.back().hash;
}

RecordReading checkRecord(std::string_view content) {
  RecordReading reading;
  std::string_view rest = content;
  const auto refuse = [&](std::string problem) {
    reading.findings.push_back({reading.entries.size() + 1, std::move(problem)});
  };
  while (!rest.empty()) {
    const std::size_t end = rest.find('\n');
    // JSON has no zeros; a file that was cut by a power loss may.
    if (end == std::string_view::npos || rest.substr(0, end).find('\0') != std::string_view::npos) {
      const bool isLast = end == std::string_view::npos || end + 1 == rest.size();
      if (isLast) reading.tornBytes = rest.size();
      refuse(isLast ? "breaks off" : "was changed: it has bytes that no line has");
      return reading;
    }
    auto entry = entryOf(rest.substr(0, end));
    if (!entry) {
      refuse(entry.error().problem);
      return reading;
    }
    std::string fault = linkFault(reading, *entry);
    if (fault.empty()) fault = timeFault(reading, *entry);
    if (!fault.empty()) {
      refuse(std::move(fault));
      return reading;
    }
    noteClock(reading, *entry);
    reading.entries.push_back(std::move(*entry));
    reading.chainedBytes += end + 1;
    rest.remove_prefix(end + 1);
  }
  if (!reading.isSignedOff()) {
    reading.findings.push_back(
        {0, "is not signed off: it is unfinished, or last lines were removed"});
  }
  return reading;
}

hal::Result<RecordReading> checkRecordFile(const fs::path& path) {
  std::error_code failure;
  const fs::file_status status = fs::status(path, failure);
  if (failure) {
    return tl::unexpected(hal::errnoError(path.string(), "cannot open", failure.value()));
  }
  const std::uintmax_t size = fs::is_regular_file(status) ? fs::file_size(path, failure) : 0;
  if (!fs::is_regular_file(status) || size > kMaxRecordBytes) {
    return tl::unexpected(hal::Error{.kind = hal::ErrorKind::kInvalidInput,
                                     .subject = path.string(),
                                     .problem = "is no file of at most 256 MiB"});
  }
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) return tl::unexpected(hal::errnoError(path.string(), "cannot open", errno));
  std::string content(size, '\0');
  file.read(content.data(), static_cast<std::streamsize>(content.size()));
  if (file.bad()) return tl::unexpected(hal::errnoError(path.string(), "cannot read", EIO));
  content.resize(static_cast<std::size_t>(file.gcount()));
  RecordReading reading = checkRecord(content);
  checkStills(reading, path.parent_path());
  return reading;
}

}  // namespace pleinair::record
