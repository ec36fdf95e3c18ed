#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <utility>

#include "hal/error.h"
#include "pipeline/gpu/programs/shader_library.h"
#include "pipeline/gpu/texture.h"
#include "pipeline/styles/strokes/brush_file.h"
#include "pipeline/styles/strokes/brushes.h"

namespace pleinair::styles {

inline constexpr const char* kNoBrushFile = "none";

/// Whether the file is a brush's, or kNoBrushFile. Reads it; any thread. Errors: readBrushFile()'s.
hal::Result<void> checkBrushFile(const std::filesystem::path& file);

/// The built-in brushes, all made by the constructor, so that no frame waits for one; and those of
/// a file, made at their first use. On the thread of a GL context.
class BrushCache {
 public:
  /// Throws hal::Failure if the library's cancellation asks for it; `library` is not kept.
  explicit BrushCache(const gpu::ShaderLibrary& library);

  /// From now on brush() gives the file's, or of kNoBrushFile the built-in ones. Reads a file where
  /// it is another one than before. Errors: readBrushFile()'s; the brushes stay as they were then.
  hal::Result<void> take(const std::filesystem::path& file);

  /// makeBrush()'s, or the file's, which has no more texels than it has pixels. Valid until
  /// another file is taken. Precondition: `across` is one of kBrushTexels.
  const gpu::Texture& brush(Brush brush, int across);

 private:
  std::filesystem::path file_ = kNoBrushFile;
  std::optional<BrushMarks> marks_;
  std::map<int, gpu::Texture> ofFile_;
  std::map<std::pair<Brush, int>, gpu::Texture> builtIn_;
};

}  // namespace pleinair::styles
