#include "hal/outputs/registry.h"

#include <algorithm>
#include <array>

#include "hal/outputs/display/display_output.h"
#include "hal/outputs/frames/frames_output.h"
#include "hal/outputs/headless/headless_output.h"
#include "hal/outputs/movie/movie_output.h"
#include "hal/outputs/v4l2_loopback/loopback_output.h"
#include "hal/outputs/window/window.h"

namespace pleinair::hal {
namespace {

std::string kindsText() {
  std::string text;
  for (const OutputKind& kind : outputKinds()) {
    for (const std::string& form : kind.forms) text += (text.empty() ? "" : ", ") + form;
  }
  return text;
}

Error invalid(const std::string& target, std::string problem, std::string remedy) {
  return {.kind = ErrorKind::kInvalidArgument,
          .subject = target,
          .problem = std::move(problem),
          .remedy = std::move(remedy)};
}

/// The endings and numbered names that say what is written to a file.
std::string fileEndingsText() {
  return "end it in .mp4, .mkv, .y4m, " + writtenPictureEndings() +
         " (numbered: out/%04d.png), or give a folder";
}

bool isDevicePlace(const std::string& target) {
  return target.starts_with("/dev/") && !target.starts_with("/dev/shm/");
}

}  // namespace

std::span<const OutputKind> outputKinds() {
  static const std::array kKinds{
      windowKind(), displayKind(), loopbackKind(), headlessKind(), movieKind(), framesKind(),
  };
  return kKinds;
}

bool isBareWord(const std::string& target) {
  const std::filesystem::path path(target);
  return !target.empty() && target != "." && target != ".." && !path.has_parent_path() &&
         path.has_filename() && !path.has_extension();
}

std::vector<std::string> outputWords() {
  std::vector<std::string> words;
  for (const OutputKind& kind : outputKinds()) {
    if (kind.traits.writesFiles) continue;
    std::ranges::copy_if(kind.forms, std::back_inserter(words), isBareWord);
  }
  std::erase_if(words, [](const std::string& word) { return word.find(':') != std::string::npos; });
  return words;
}

std::vector<std::string> outputPrefixes() {
  std::vector<std::string> prefixes;
  for (const OutputKind& kind : outputKinds()) {
    if (kind.traits.writesFiles) continue;
    std::ranges::copy_if(kind.forms, std::back_inserter(prefixes), [](const std::string& form) {
      return form.find(':') != std::string::npos;
    });
  }
  return prefixes;
}

Result<const OutputKind*> outputKindOf(const std::string& target) {
  const auto kinds = outputKinds();
  const auto found =
      std::ranges::find_if(kinds, [&](const OutputKind& kind) { return kind.recognizes(target); });
  const bool isBare = isBareWord(target);
  if (found != kinds.end() && !(isBare && found->traits.writesFiles)) {
    if (!found->traits.writesFiles || !isDevicePlace(target)) return &*found;
  }
  if (isDevicePlace(target)) {
    return tl::unexpected(invalid(target, "is a device's place, not a file's",
                                  "a V4L2 loopback is loopback:" + target));
  }
  if (isBare) {
    return tl::unexpected(invalid(
        target, "is no output",
        "give " + kindsText() + "; a folder of this name is ./" + target + " or " + target + "/"));
  }
  return tl::unexpected(invalid(target, "does not say what to write", fileEndingsText()));
}

Result<std::unique_ptr<Output>> openOutput(const std::string& target,
                                           const OutputOptionsByKind& options) {
  const Result<const OutputKind*> kind = outputKindOf(target);
  if (!kind) return tl::unexpected(kind.error());
  const auto own = options.find((*kind)->name);
  return (*kind)->make(target, own == options.end() ? OutputOptions{} : own->second);
}

Result<std::unique_ptr<MemoryOutput>> openFileOutput(const std::filesystem::path& path) {
  const std::string target = path.string();
  const Result<const OutputKind*> kind = outputKindOf(target);
  if (!kind && isBareWord(target) && !isDevicePlace(target)) {
    return tl::unexpected(invalid(target, "does not say what to write",
                                  fileEndingsText() + ": ./" + target + " or " + target + "/"));
  }
  if (!kind) return tl::unexpected(kind.error());
  if (!(*kind)->traits.writesFiles) {
    return tl::unexpected(
        invalid(path.string(), "is no file",
                "give a movie or pictures; `pleinair run` paints to a " + (*kind)->name));
  }
  Result<std::unique_ptr<Output>> output = (*kind)->make(path.string(), {});
  if (!output) return tl::unexpected(output.error());
  return std::unique_ptr<MemoryOutput>((*output).release()->memory());
}

}  // namespace pleinair::hal
