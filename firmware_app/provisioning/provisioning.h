#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hal/clock.h"
#include "hal/repeated_reading.h"

namespace pleinair::app {

/// Where a machine's setting up is looked for, by a person who has no shell on it.
struct ProvisioningPlaces {
  /// Folders with a site.toml and what it names, the strongest first: systemd's credentials, a
  /// mounted partition. They need not exist.
  std::vector<std::filesystem::path> folders;
  std::filesystem::path state;  ///< where the last good one is kept

  /// $CREDENTIALS_DIRECTORY where it has a site file, then `folder`, where one is given.
  static ProvisioningPlaces of(const std::optional<std::filesystem::path>& folder,
                               std::filesystem::path state);
};

/// What a machine is set up by.
struct Provisioned {
  std::optional<std::filesystem::path> siteFile;  ///< a copy in the state folder; unset: none
  std::string origin;  ///< where that came from, for people; empty: nowhere
  std::string found;   ///< the folder that had a site file, good or not; empty: none had
  /// What is wrong with what was found, a line each: file, line, problem, remedy. The site file in
  /// force is then the last good one, if there was one.
  std::vector<std::string> problems;
};

/// Reads all that a site file leads to, and throws config::ConfigError or hal::Failure for what is
/// wrong. `text`: in place of the file's own.
using SiteCheck = std::function<void(const std::filesystem::path& siteFile,
                                     const std::optional<std::string>& text)>;

/// Takes what the strongest place has, if it is good, and keeps it; else what was kept before.
Provisioned provision(const ProvisioningPlaces& places, const SiteCheck& check);

/// The last good one, unchecked; for what must not change anything. Nothing where there is none.
std::optional<std::filesystem::path> keptSiteFile(const std::filesystem::path& state);

/// What is wrong with a site file, a line each, at most kMostProblems, with paths from its folder
/// on; empty: nothing. Of what the file names, the first only.
std::vector<std::string> problemsOf(const std::filesystem::path& siteFile, const SiteCheck& check);
inline constexpr int kMostProblems = 5;

/// What a screen says about it, in lines; empty where all is well. `hasOther`: there is a site file
/// elsewhere, so that the machine is no new one.
std::string provisioningText(const Provisioned& provisioned, bool hasOther);

/// Notices that another medium has come, or the same with other files. Any thread.
class SiteWatch {
 public:
  static constexpr hal::Duration kInterval = std::chrono::seconds(2);

  /// To be made before the places are read. `interval`: real time between two looks.
  explicit SiteWatch(const ProvisioningPlaces& places, hal::Duration interval = kInterval);

  /// Whether a place has something else than at first, and has had it for two looks: it is no
  /// longer being written; or the same as at first again, after it was gone, where `hadProblems`:
  /// it may have been pulled while it was read. Nothing is changed by a medium that goes.
  bool hasChanged(bool hadProblems = false) const;
  /// How often it has looked.
  std::uint64_t looks() const;

 private:
  struct Seen {
    std::string fingerprint;
    int times = 0;
    bool wasGone = false;  ///< nothing was there at some look
  };
  std::string first_;
  hal::RepeatedReading<Seen> looks_;
};

}  // namespace pleinair::app
