#pragma once

#include <filesystem>
#include <memory>

#include "hal/media/picture_encoder.h"
#include "hal/output.h"
#include "hal/output_kind.h"
#include "hal/pending_file.h"

namespace pleinair::hal {

/// Pictures, of the kind that the ending says (writtenPictureKind()); takes RGB8. `path` is
/// - a pattern such as "out/%04d.png" (see NumberedPath), numbered from 0,
/// - a folder, made if it is missing (its parent must exist), for "%06d.png" in it,
/// - one picture's name, published in finish(); a second one is an error.
/// Numbered pictures are published whole, each as it comes; start() removes partial ones that a
/// killed run left. Errors of start() also: kInvalidArgument (the pattern is malformed, or has
/// an unknown ending), kBusy (another output, of any process, writes to the pattern).
std::unique_ptr<MemoryOutput> openFramesOutput(std::filesystem::path path,
                                               FileSystem& files = systemFiles());

/// The same with options.
std::unique_ptr<MemoryOutput> openFramesOutput(std::filesystem::path path,
                                               const PictureFileOptions& options,
                                               FileSystem& files = systemFiles());

/// One picture, a numbered pattern, or a folder.
OutputKind framesKind();

}  // namespace pleinair::hal
