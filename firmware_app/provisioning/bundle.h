#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>

#include "hal/error.h"

namespace pleinair::app {

inline constexpr std::string_view kSiteName = "site.toml";

/// The files of a folder that a machine is set up by, as they were read: a site file, and what it
/// names. By their paths in the folder: "site.toml", "models/cup.gltf".
struct Bundle {
  std::map<std::string, std::string> files;
};

struct BundleLimits {
  std::size_t files = 256;
  std::size_t bytes = std::size_t{32} << 20;  ///< of all of them
  int depth = 4;                              ///< of folders in the folder
};

/// Whether a folder has a site file, of whatever kind, or one whose name is nearly that, or cannot
/// be opened though it is there.
bool hasSite(const std::filesystem::path& folder);

/// Reads all of a folder that anybody may have written. Hidden files and those that systems put on
/// media are left out; "Site.TOML" is "site.toml". Follows no symbolic link and opens no device, so
/// that nothing outside the folder is read. Errors name the file within the folder:
/// kInvalidInput (a symbolic link, a device, too many files, too large, not UTF-8, no site file
/// but "site.toml.txt"), kPermissionDenied, kIo.
hal::Result<Bundle> readBundle(const std::filesystem::path& folder,
                               const BundleLimits& limits = {});

/// The same for the same paths and contents only: 64 hexadecimal digits.
std::string digestOf(const Bundle& bundle);

/// Sizes and times of the folder's files, without reading them: differs where the folder was
/// written. Empty where it has no site file.
std::string fingerprintOf(const std::filesystem::path& folder);

}  // namespace pleinair::app
