#pragma once

#include <filesystem>
#include <vector>

#include "hal/error.h"

namespace pleinair::scene {

/// The files that a model's file needs beside itself, sorted, each once: buffers and images of a
/// .gltf, material libraries of an .obj. Those that are not there, or not in its folder, are left
/// out: readers do not open them either. Opens no file but `model`. Errors: kInvalidInput (broken),
/// and FileInput's. Any thread.
hal::Result<std::vector<std::filesystem::path>> filesBeside(const std::filesystem::path& model);

}  // namespace pleinair::scene
