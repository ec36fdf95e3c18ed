#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "hal/error.h"
#include "hal/numbered_path.h"

namespace pleinair::hal {

/// Whether the name has a picture file's extension (.png, .JPG …).
bool isPictureName(const std::filesystem::path& path);

/// The names of the other files in a folder of pictures, in natural order, without hidden ones.
/// Empty for anything else than a folder.
std::vector<std::string> otherFilesIn(const std::filesystem::path& folder);

/// Natural order: runs of digits compare as numbers ("a2" before "a10").
bool naturallyLess(std::string_view a, std::string_view b);

/// The picture files of a folder, not of its subfolders, in natural order, without hidden files.
/// Errors: kInvalidInput (none), kPermissionDenied, kIo.
Result<std::vector<std::filesystem::path>> picturesIn(const std::filesystem::path& folder);

/// The files that a pattern names, from the smallest number up to the first gap. Errors: kNotFound
/// (none), kPermissionDenied, kIo.
Result<std::vector<std::filesystem::path>> picturesOf(const NumberedPath& pattern,
                                                      std::string_view patternText);

}  // namespace pleinair::hal
