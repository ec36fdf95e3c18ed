#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hal/error.h"
#include "pipeline/record/record_entry.h"

namespace pleinair::record {

/// What is wrong with a record.
struct RecordFinding {
  std::uint64_t line = 0;  ///< from 1; 0: the whole record
  std::string problem;
};

/// A record's lines as far as they form a chain, and what is wrong with it.
struct RecordReading {
  std::vector<RecordEntry> entries;  ///< up to the first line that is wrong
  std::vector<RecordFinding> findings;
  std::vector<std::string> notes;  ///< nothing is wrong: the wall clock was set back
  std::uint64_t chainedBytes = 0;  ///< of the lines in `entries`
  /// Bytes after them that a power cut may have left of a line: without an end, or with zeros.
  std::uint64_t tornBytes = 0;

  bool isSignedOff() const;
  /// The hash of the last line; 64 zeros without one.
  const std::string& finalHash() const;
};

/// Where a still is, by the folder of its record; nothing where it would be outside of it, also
/// through links. It need not be there.
std::optional<std::filesystem::path> pathOfStill(const StillTaken& still,
                                                 const std::filesystem::path& folder);

/// Verifies the lines of a record: each one's hash, that each follows the one before, also in time
/// within one start of the machine, that the last one signs it off. Findings stop at the first line
/// that breaks the chain.
RecordReading checkRecord(std::string_view content);

/// Reads and verifies a record of at most 256 MiB, and the stills that it names. Errors: kNotFound,
/// kPermissionDenied, kInvalidInput (no regular file, too large), kIo.
hal::Result<RecordReading> checkRecordFile(const std::filesystem::path& path);

}  // namespace pleinair::record
