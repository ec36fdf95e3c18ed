#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "hal/output.h"
#include "hal/output_kind.h"

namespace pleinair::hal {

/// Every kind of outputs that the program has, in the order in which a target is tried. Any thread.
std::span<const OutputKind> outputKinds();

/// The kind that a target names. A bare word that is no kind's is an error that says how a folder
/// of that name is written ("./display", "display/"), for it may be a slip, or another version's
/// output. Errors: kInvalidArgument, which lists the kinds.
Result<const OutputKind*> outputKindOf(const std::string& target);

/// Whether `target` is one word, without a separator or an ending, so that it can only be a kind's.
bool isBareWord(const std::string& target);

/// "window", "headless", "loopback": the targets that are whole words.
std::vector<std::string> outputWords();
/// "loopback:DEVICE": the targets that go on after a colon.
std::vector<std::string> outputPrefixes();

/// The options of every kind, by the kind's name.
using OutputOptionsByKind = std::map<std::string, OutputOptions, std::less<>>;

/// The output that `target` names, not started. Errors: those of outputKindOf() and of the kind's
/// make().
Result<std::unique_ptr<Output>> openOutput(const std::string& target,
                                           const OutputOptionsByKind& options = {});

/// The output to files that `path` names: a movie (.mp4, .mkv, .y4m), one picture, a numbered
/// pattern such as "out/%04d.png", or a folder of numbered PNGs (one that ends in a slash, or has a
/// separator and no ending). Opens nothing yet. Errors: kInvalidArgument (a device's place; an
/// unknown ending: lists those that are known; a bare word).
Result<std::unique_ptr<MemoryOutput>> openFileOutput(const std::filesystem::path& path);

}  // namespace pleinair::hal
