#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "firmware_app/provisioning/bundle.h"
#include "hal/error.h"

namespace pleinair::app {

/// The bundle that a machine is set up by, kept in its state folder, so that what it came from may
/// be taken away, and so that a bad one does not replace it. A file there names the copy in force
/// and is replaced at once: a power cut leaves the one before or the new one, never a part. One
/// thread, one process.
class KeptSite {
 public:
  struct Copy {
    std::string digest;  ///< digestOf() of the bundle
    std::filesystem::path folder;
    std::filesystem::path siteFile() const { return folder / kSiteName; }
  };

  /// `state`: the folder; made at need. Empty: there is none.
  explicit KeptSite(std::filesystem::path state) : state_(std::move(state)) {}

  /// The copy in force; nothing where there is none, or where it is not as it was written.
  std::optional<Copy> inForce() const;
  /// Writes a copy to the disk, which is not in force yet. Errors: kNotFound (no state folder),
  /// kPermissionDenied, kNoSpace, kIo.
  hal::Result<Copy> write(const Bundle& bundle) const;
  /// Puts a copy in force, and removes all others. Errors: as of write(); the one before is in
  /// force then.
  hal::Result<void> putInForce(const Copy& copy) const;
  /// Removes a copy that is not in force.
  void discard(const Copy& copy) const;

 private:
  std::filesystem::path pointer() const;
  std::filesystem::path folderOf(const std::string& digest) const;
  void removeAllBut(const std::filesystem::path& kept) const;

  std::filesystem::path state_;
};

}  // namespace pleinair::app
