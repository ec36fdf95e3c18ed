#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "hal/error.h"
#include "pipeline/record/record_check.h"
#include "pipeline/record/record_entry.h"
#include "pipeline/record/record_file.h"

namespace pleinair::record {

/// Writes a record, a line for each event; each is on the disk when the call returns. A call that
/// fails has written nothing and can be repeated (RecordFile::append() names the exceptions). One
/// thread at a time.
class RecordWriter {
 public:
  /// Begins a record. Errors: those of RecordFile::create().
  static hal::Result<RecordWriter> create(const std::filesystem::path& path, const Begun& begun,
                                          MomentSource clock = systemMoment,
                                          RecordSystem system = RecordSystem::real());
  /// Goes on with a record that was not signed off. A line that a power cut tore is cut off; it was
  /// never acknowledged. Errors: those of RecordFile::open() and checkRecordFile(), and
  /// kInvalidInput for a record that was changed or is signed off.
  static hal::Result<RecordWriter> resume(const std::filesystem::path& path,
                                          const std::string& program,
                                          MomentSource clock = systemMoment,
                                          RecordSystem system = RecordSystem::real());

  /// Precondition: not signed off.
  hal::Result<void> add(Event event);
  /// Saves a still beside the record, in a folder of the record's name, and adds it.
  hal::Result<void> addStill(const std::string& step, const std::string& when,
                             std::span<const std::uint8_t> png);

  /// All lines so far, those before a resumption too.
  const std::vector<RecordEntry>& entries() const { return entries_; }
  /// Of the last line: what a sign-off is compared with elsewhere.
  const std::string& finalHash() const { return entries_.back().hash; }
  bool isSignedOff() const { return std::holds_alternative<SignedOff>(entries_.back().event); }
  const std::filesystem::path& path() const { return path_; }

 private:
  RecordWriter(std::filesystem::path path, RecordFile file, std::vector<RecordEntry> entries,
               MomentSource clock);

  std::filesystem::path path_;
  RecordFile file_;
  std::vector<RecordEntry> entries_;
  MomentSource clock_;
};

}  // namespace pleinair::record
