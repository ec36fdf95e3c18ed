#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace pleinair::app {

/// A file, or a row of pictures, and the option that names it, or what it is.
struct NamedPath {
  std::string option;  ///< "--input", "a file of the scene"
  std::filesystem::path path;
};

/// Whether `output` means numbered pictures, each published as it comes: a folder or a pattern.
bool isPictureRow(const std::filesystem::path& output);

/// Nothing may be written over what is read, nor two things into one place; pictures may not go
/// into the folder that pictures are read from. Links are followed. Throws hal::Failure
/// (kInvalidArgument).
void refuseCollisions(const std::vector<NamedPath>& read, const std::vector<NamedPath>& written);

}  // namespace pleinair::app
