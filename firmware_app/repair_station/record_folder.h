#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace pleinair::app {

/// The newest record of a procedure in a folder, if it is not signed off: work to go on with.
std::optional<std::filesystem::path> openRecordIn(const std::filesystem::path& folder,
                                                  const std::string& procedure);

/// A path for a new record: the procedure's name and the time (UTC). Nothing is there yet.
std::filesystem::path newRecordIn(const std::filesystem::path& folder,
                                  const std::string& procedure);

}  // namespace pleinair::app
