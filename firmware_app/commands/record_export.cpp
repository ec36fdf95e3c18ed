#include <cstdint>
#include <fstream>
#include <iterator>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "firmware_app/cli/counted_text.h"
#include "firmware_app/cli/exit_status.h"
#include "firmware_app/cli/path_collisions.h"
#include "firmware_app/cli/standard_streams.h"
#include "firmware_app/commands/procedure.h"
#include "hal/error.h"
#include "pipeline/record/record_check.h"
#include "pipeline/record/record_report.h"
#include "pipeline/record/zip_file.h"

namespace pleinair::app {
namespace {

namespace fs = std::filesystem;

using hal::orThrow;

std::string contentOf(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    throw hal::Failure({.kind = hal::ErrorKind::kNotFound,
                        .subject = path.string(),
                        .problem = "cannot be read",
                        .remedy = {}});
  }
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// A record, its stills, the report and the procedure in one archive, below a folder of the
/// record's name.
class RecordExport {
 public:
  RecordExport(const RecordExportOptions& options, const record::RecordReading& reading)
      : options_(options),
        reading_(reading),
        folder_(options.record.stem().string() + "/"),
        zip_(orThrow(record::ZipFile::create(options.output))) {}

  void write(const procedure::Procedure* procedure) {
    add(options_.record.filename().string(), contentOf(options_.record));
    addStills();
    add("report.html", record::htmlReport(reading_, procedure));
    if (procedure != nullptr) {
      for (const std::string& file : procedure->files) {
        add("procedure/" + file, contentOf(*options_.procedure / file));
      }
    }
    orThrow(zip_.publish());
  }

  std::size_t files() const { return added_.size(); }

 private:
  /// Those that are there: what is missing is a finding, and in the report. A record from elsewhere
  /// may name any file of this machine.
  void addStills() {
    for (const record::RecordEntry& entry : reading_.entries) {
      const auto* still = std::get_if<record::StillTaken>(&entry.event);
      if (still == nullptr) continue;
      const auto path = record::pathOfStill(*still, options_.record.parent_path());
      std::error_code failure;
      if (path && fs::is_regular_file(*path, failure)) add(still->file, contentOf(*path));
    }
  }

  void add(const std::string& name, const std::string& content) {
    if (!added_.insert(name).second) return;
    const auto modified =
        reading_.entries.empty() ? record::WallTime{} : reading_.entries.back().moment.wall;
    orThrow(zip_.add(folder_ + name, content, modified));
  }

  const RecordExportOptions& options_;
  const record::RecordReading& reading_;
  std::string folder_;
  record::ZipFile zip_;
  std::set<std::string> added_;
};

}  // namespace

int exportRecord(const RecordExportOptions& options) {
  refuseCollisions({{"FILE", options.record}}, {{"--output", options.output}});
  const record::RecordReading reading = orThrow(record::checkRecordFile(options.record));
  const auto procedure = procedureOfRecord(options.procedure, reading);
  RecordExport archive(options, reading);
  archive.write(procedure ? &*procedure : nullptr);
  writeText(stdout,
            fmt::format("{}: {}\n", options.output.string(), countedText(archive.files(), "file")));
  printFindings(options.record, reading);
  return reading.findings.empty() ? 0 : static_cast<int>(ExitStatus::kInternal);
}

}  // namespace pleinair::app
