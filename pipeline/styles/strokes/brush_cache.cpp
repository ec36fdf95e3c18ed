#include "pipeline/styles/strokes/brush_cache.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace pleinair::styles {
namespace {

gpu::Texture textureOf(const BrushMarks& marks) {
  const hal::FrameSize size{4 * marks.across, marks.across * kBrushVariants};
  std::vector<std::uint8_t> texels = marks.texels;
  while (texels.size() < static_cast<std::size_t>(size.pixels()) * 2) {
    texels.insert(texels.end(), marks.texels.begin(), marks.texels.end());
  }
  gpu::Texture texture(gpu::TextureFormat::kRg8, size, gpu::TextureFilter::kLinear);
  texture.upload(texels, static_cast<std::size_t>(size.width) * 2);
  return texture;
}

}  // namespace

BrushCache::BrushCache(const gpu::ShaderLibrary& library) {
  for (const Brush brush : kBrushes) {
    for (const int across : kBrushTexels) {
      library.throwIfCancelled();
      builtIn_.emplace(std::pair(brush, across), makeBrush(brush, across));
    }
  }
}

hal::Result<void> checkBrushFile(const std::filesystem::path& file) {
  if (file == kNoBrushFile) return {};
  const hal::Result<BrushMarks> marks = readBrushFile(file);
  return marks ? hal::Result<void>() : tl::unexpected(marks.error());
}

hal::Result<void> BrushCache::take(const std::filesystem::path& file) {
  if (file == file_) return {};
  std::optional<BrushMarks> marks;
  if (file != kNoBrushFile) {
    hal::Result<BrushMarks> read = readBrushFile(file);
    if (!read) return tl::unexpected(std::move(read.error()));
    marks = *std::move(read);
  }
  marks_ = std::move(marks);
  ofFile_.clear();
  file_ = file;
  return {};
}

const gpu::Texture& BrushCache::brush(Brush brush, int across) {
  if (marks_) {
    const auto known = ofFile_.find(across);
    if (known != ofFile_.end()) return known->second;
    return ofFile_.emplace(across, textureOf(reducedTo(*marks_, across))).first->second;
  }
  return builtIn_.at({brush, across});
}

}  // namespace pleinair::styles
