#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "hal/error.h"
#include "pipeline/record/record_entry.h"

namespace pleinair::record {

/// A ZIP archive that is written entry by entry, by libarchive, and takes its name only when it is
/// complete. Equal entries give equal bytes. One thread at a time.
class ZipFile {
 public:
  /// Errors: those of hal::PendingFile::create().
  static hal::Result<ZipFile> create(const std::filesystem::path& path);
  ZipFile(ZipFile&&) noexcept;
  ZipFile& operator=(ZipFile&&) noexcept;
  ~ZipFile();

  /// Adds a file. `name`: its path in the archive, with '/'. Pictures are stored as they are.
  /// Errors: kNoSpace, kIo.
  hal::Result<void> add(const std::string& name, std::string_view content, WallTime modified);
  /// Ends the archive and gives it its name. Errors: kNoSpace, kIo.
  hal::Result<void> publish();

 private:
  struct State;
  explicit ZipFile(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace pleinair::record
