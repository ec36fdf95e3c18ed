#include "pipeline/record/record_check.h"

#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "firmware_app/cli/exit_status.h"
#include "firmware_app/cli/path_collisions.h"
#include "firmware_app/cli/standard_streams.h"
#include "firmware_app/commands/procedure.h"
#include "hal/error.h"
#include "hal/pending_file.h"
#include "pipeline/procedure/procedure_file.h"
#include "pipeline/record/record_report.h"

namespace pleinair::app {
namespace {

using hal::orThrow;

/// A procedure of another version would give titles that nobody saw.
void refuseOtherVersion(const procedure::Procedure& procedure,
                        const record::RecordReading& reading) {
  std::string hash;
  for (const record::RecordEntry& entry : reading.entries) {
    if (const auto* begun = std::get_if<record::Begun>(&entry.event)) hash = begun->hash;
    if (const auto* changed = std::get_if<record::ProcedureChanged>(&entry.event)) {
      hash = changed->hash;
    }
  }
  if (hash == procedure.hash) return;
  throw hal::Failure({.kind = hal::ErrorKind::kInvalidArgument,
                      .subject = "--procedure",
                      .problem = "is not the version that was carried out, whose hash is " + hash,
                      .remedy = "that version, or no --procedure"});
}

void writeReport(const RecordCheckOptions& options, const record::RecordReading& reading) {
  refuseCollisions({{"FILE", options.record}}, {{"--report", *options.report}});
  const auto procedure = procedureOfRecord(options.procedure, reading);
  const std::string html = record::htmlReport(reading, procedure ? &*procedure : nullptr);
  hal::PendingFile file = orThrow(hal::PendingFile::create(*options.report));
  orThrow(file.write({reinterpret_cast<const std::uint8_t*>(html.data()), html.size()}));
  orThrow(file.publish());
}

}  // namespace

std::optional<procedure::Procedure> procedureOfRecord(
    const std::optional<std::filesystem::path>& folder, const record::RecordReading& reading) {
  if (!folder) return std::nullopt;
  procedure::Procedure procedure = procedure::loadProcedure(*folder);
  refuseOtherVersion(procedure, reading);
  return procedure;
}

void printFindings(const std::filesystem::path& file, const record::RecordReading& reading) {
  for (const record::RecordFinding& finding : reading.findings) {
    printError(finding.line > 0
                   ? fmt::format("{}:{}: {}", file.string(), finding.line, finding.problem)
                   : fmt::format("{}: {}", file.string(), finding.problem));
  }
}

int checkRecordOfWork(const RecordCheckOptions& options) {
  record::RecordReading reading = orThrow(record::checkRecordFile(options.record));
  if (options.finalHash && reading.finalHash() != *options.finalHash) {
    const bool isLineBefore =
        !reading.entries.empty() && reading.entries.back().previous == *options.finalHash;
    reading.findings.push_back(
        {0, isLineBefore
                ? fmt::format("{} is the hash of the line before the sign-off: the final hash is "
                              "the last line's \"hash\"",
                              *options.finalHash)
                : fmt::format("ends with the hash {}, not with {}", reading.finalHash(),
                              *options.finalHash)});
  }
  if (options.report) writeReport(options, reading);
  for (const std::string& note : reading.notes) spdlog::info("{}", note);
  printFindings(options.record, reading);
  if (!reading.findings.empty()) return static_cast<int>(ExitStatus::kInternal);
  const auto& end = std::get<record::SignedOff>(reading.entries.back().event);
  const bool isWhole = end.result == record::SignOff::kCompleted;
  writeText(stdout,
            fmt::format("{}: {} lines, unchanged and signed off as {} by {}\n"
                        "  final hash: {}\n",
                        options.record.string(), reading.entries.size(),
                        isWhole ? "completed" : "aborted", end.operatorName, reading.finalHash()));
  return 0;
}

}  // namespace pleinair::app
