#pragma once

#include <filesystem>
#include <optional>

namespace pleinair::hal::movie {

enum class FileKind { kMp4, kMkv, kY4m };

/// By the ending, in either case.
std::optional<FileKind> fileKindOf(const std::filesystem::path& path);

}  // namespace pleinair::hal::movie
