#include "pipeline/record/record_writer.h"

#include <cassert>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "hal/pending_file.h"
#include "pipeline/digest/sha256.h"

namespace pleinair::record {
namespace {

namespace fs = std::filesystem;

hal::Error resumeFault(const fs::path& path, std::string problem) {
  return {.kind = hal::ErrorKind::kInvalidInput,
          .subject = path.string(),
          .problem = std::move(problem),
          .remedy = "`pleinair record-check` says more; begin another record"};
}

}  // namespace

RecordWriter::RecordWriter(fs::path path, RecordFile file, std::vector<RecordEntry> entries,
                           MomentSource clock)
    : path_(std::move(path)),
      file_(std::move(file)),
      entries_(std::move(entries)),
      clock_(std::move(clock)) {}

hal::Result<RecordWriter> RecordWriter::create(const fs::path& path, const Begun& begun,
                                               MomentSource clock, RecordSystem system) {
  auto file = RecordFile::create(path, std::move(system));
  if (!file) return tl::unexpected(std::move(file.error()));
  RecordWriter writer(path, std::move(*file), {}, std::move(clock));
  if (auto added = writer.add(begun); !added) {
    std::error_code ignored;
    fs::remove(path, ignored);  // an empty record would stand in the way of the next attempt
    return tl::unexpected(std::move(added.error()));
  }
  return writer;
}

hal::Result<RecordWriter> RecordWriter::resume(const fs::path& path, const std::string& program,
                                               MomentSource clock, RecordSystem system) {
  // Locked first: what is read then is not appended to by another program meanwhile.
  auto file = RecordFile::open(path, std::move(system));
  if (!file) return tl::unexpected(std::move(file.error()));
  auto reading = checkRecordFile(path);
  if (!reading) return tl::unexpected(std::move(reading.error()));
  if (reading->isSignedOff()) return tl::unexpected(resumeFault(path, "is signed off"));
  for (const RecordFinding& finding : reading->findings) {
    const bool isTorn = reading->tornBytes > 0 && finding.line == reading->entries.size() + 1;
    // Of a whole line, what is wrong is its still, which is told in the end; the work goes on.
    const bool isOfStill = finding.line <= reading->entries.size();
    if (isOfStill || isTorn) continue;
    return tl::unexpected(
        resumeFault(path, fmt::format("line {} {}", finding.line, finding.problem)));
  }
  if (reading->entries.empty()) {
    return tl::unexpected(resumeFault(path, "has no line that was completed"));
  }
  if (auto cut = file->cutAfter(reading->chainedBytes); !cut) {
    return tl::unexpected(std::move(cut.error()));
  }
  RecordWriter writer(path, std::move(*file), std::move(reading->entries), std::move(clock));
  if (auto added = writer.add(Resumed{.cutBytes = reading->tornBytes, .program = program});
      !added) {
    return tl::unexpected(std::move(added.error()));
  }
  return writer;
}

hal::Result<void> RecordWriter::add(Event event) {
  assert(entries_.empty() || !isSignedOff());
  RecordEntry entry{.number = entries_.size(),
                    .previous = entries_.empty() ? noHash() : finalHash(),
                    .moment = clock_(),
                    .event = std::move(event)};
  const std::string line = lineOf(entry);
  if (line.size() > kMaxLineBytes) {
    return tl::unexpected(hal::Error{.kind = hal::ErrorKind::kInvalidArgument,
                                     .subject = path_.string(),
                                     .problem = "the entry is too long",
                                     .remedy = "shorter texts"});
  }
  if (auto appended = file_.append(line); !appended) return appended;
  entries_.push_back(std::move(entry));
  return {};
}

hal::Result<void> RecordWriter::addStill(const std::string& step, const std::string& when,
                                         std::span<const std::uint8_t> png) {
  const fs::path folder = path_.stem().string() + ".stills";
  // The number of the line makes the name unique, also after a resumption.
  const fs::path file = folder / fmt::format("{:04}-{}-{}.png", entries_.size(), step, when);
  std::error_code failure;
  fs::create_directories(path_.parent_path() / folder, failure);
  if (failure) {
    return tl::unexpected(hal::errnoError((path_.parent_path() / folder).string(), "cannot create",
                                          failure.value(), "free space, then repeat the step"));
  }
  auto pending = hal::PendingFile::create(path_.parent_path() / file);
  if (!pending) return tl::unexpected(std::move(pending.error()));
  if (auto written = pending->write(png); !written) return written;
  if (auto published = pending->publish(); !published) return published;
  const std::string_view bytes(reinterpret_cast<const char*>(png.data()), png.size());
  return add(StillTaken{.step = step,
                        .when = when,
                        .file = file.string(),
                        .sha256 = digest::hexOf(digest::sha256(bytes)),
                        .bytes = png.size()});
}

}  // namespace pleinair::record
